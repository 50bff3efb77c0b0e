#include "assets.hpp"

#include <algorithm>
#include <array>

// From assets.S, made by CMake of what web/build.mjs wrote.
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

}  // namespace

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
