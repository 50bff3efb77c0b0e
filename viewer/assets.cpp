#include "assets.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <cstring>

#include <boost/beast/core/error.hpp>
#include <boost/beast/zlib/inflate_stream.hpp>

#include "sinew/core/error.hpp"

// From assets.S, which CMake makes from the output of web/build.mjs.
extern "C" {
extern const char sinew_web_index_begin[], sinew_web_index_end[];
extern const char sinew_web_script_begin[], sinew_web_script_end[];
extern const char sinew_web_style_begin[], sinew_web_style_end[];
}

namespace sinew::viewer {

namespace {

std::string_view between(const char* begin, const char* end) {
  return {begin, static_cast<std::size_t>(end - begin)};
}

// "gzip;q=0.5" is the coding "gzip" with quality 0.5. The default quality is 1.
bool wants_gzip(std::string_view entry) {
  std::string word;
  for (const char letter : entry) {
    if (letter == ' ' || letter == '\t') continue;
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  }
  const std::size_t mark = word.find(';');
  const std::string coding = word.substr(0, mark);
  if (coding != "gzip" && coding != "x-gzip" && coding != "*") return false;
  const std::size_t quality = word.find("q=", mark == std::string::npos ? word.size() : mark);
  return quality == std::string::npos || std::strtod(word.c_str() + quality + 2, nullptr) > 0.0;
}

}  // namespace

// The file is a gzip member without optional fields (RFC 1952, section 2.3): a header of 10 bytes,
// deflated data, CRC-32, and the uncompressed length.
std::string unpack(const Asset& asset) {
  constexpr std::size_t kHeader = 10, kTrailer = 8;
  std::uint32_t length = 0;
  std::memcpy(&length, asset.bytes.data() + asset.bytes.size() - sizeof length, sizeof length);
  std::string bytes(length, '\0');
  boost::beast::zlib::inflate_stream stream;
  boost::beast::zlib::z_params work;
  work.next_in = asset.bytes.data() + kHeader;
  work.avail_in = asset.bytes.size() - kHeader - kTrailer;
  work.next_out = bytes.data();
  work.avail_out = bytes.size();
  boost::beast::error_code error;
  stream.write(work, boost::beast::zlib::Flush::finish, error);
  if (work.avail_out != 0 || error != boost::beast::zlib::error::end_of_stream) {
    throw Error(ErrorKind::internal, {.item = std::string(asset.path)},
                "this file of the page is damaged", "build the program again");
  }
  return bytes;
}

bool accepts_gzip(std::string_view header) {
  while (!header.empty()) {
    const std::size_t comma = std::min(header.find(','), header.size());
    if (wants_gzip(header.substr(0, comma))) return true;
    header.remove_prefix(std::min(comma + 1, header.size()));
  }
  return false;
}

const Asset* find_asset(std::string_view path) {
  static const std::array<Asset, 3> assets = {
      Asset{"/", "text/html; charset=utf-8", between(sinew_web_index_begin, sinew_web_index_end)},
      Asset{"/app.js", "text/javascript; charset=utf-8",
            between(sinew_web_script_begin, sinew_web_script_end)},
      Asset{"/app.css", "text/css; charset=utf-8",
            between(sinew_web_style_begin, sinew_web_style_end)}};
  const auto found = std::ranges::find(assets, path, &Asset::path);
  return found == assets.end() ? nullptr : &*found;
}

}  // namespace sinew::viewer
