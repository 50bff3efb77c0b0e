/// @file
/// Base64 and zlib, as VTK's XML files use them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace sinew::mesh {

/// Decodes base64 until `max_bytes` are there or the text ends. White space is passed over, and
/// padding in the middle ends one run and starts the next, as VTK writes it. Nothing when a
/// character is no base64.
/// @param text the encoded text.
/// @param max_bytes how many are wanted.
std::optional<std::string> decode_base64(std::string_view text, std::size_t max_bytes);

/// Encodes with padding and without line breaks.
/// @param bytes to encode.
std::string encode_base64(std::string_view bytes);

/// Unpacks one zlib stream of exactly `size` bytes; nothing when it is damaged or of another size.
/// A size beyond what zlib can reach (1032 : 1) is refused before anything is allocated.
/// @param packed the compressed bytes.
/// @param size of the result.
std::optional<std::string> inflate(std::string_view packed, std::size_t size);

/// Packs with zlib at its default level.
/// @param bytes to compress.
std::string deflate(std::string_view bytes);

}  // namespace sinew::mesh
