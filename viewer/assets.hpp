/// @file
/// The web page, embedded in the library. Nothing is read from disk for a browser.
#pragma once

#include <string>
#include <string_view>

namespace sinew::viewer {

/// A file of the page, compressed with gzip.
struct Asset {
  std::string_view path;  ///< "/app.js"
  std::string_view content_type;
  std::string_view bytes;
};

/// Decompresses the content of a file.
std::string unpack(const Asset& asset);

/// Whether an Accept-Encoding header allows gzip (RFC 9110, section 12.5.3).
/// @param header empty if the client sent none; the result is then false.
bool accepts_gzip(std::string_view header);

/// The file at a path; null if there is none.
const Asset* find_asset(std::string_view path);

}  // namespace sinew::viewer
