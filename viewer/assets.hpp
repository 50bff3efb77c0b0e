/// @file
/// The page, kept within the library: nothing is ever read from disk for a browser.
#pragma once

#include <string>
#include <string_view>

namespace sinew::viewer {

/// A file of the page, compressed by gzip.
struct Asset {
  std::string_view path;  ///< "/app.js"
  std::string_view content_type;
  std::string_view bytes;
};

/// The same without compression.
std::string unpack(const Asset& asset);

/// Whether an Accept-Encoding header has gzip (RFC 9110, section 12.5.3). @param header empty where
/// the client sent none; it then gets no compression.
bool accepts_gzip(std::string_view header);

/// The file at a path; null when there is none.
const Asset* find_asset(std::string_view path);

}  // namespace sinew::viewer
