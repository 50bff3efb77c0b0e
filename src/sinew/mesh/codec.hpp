/// @file
/// Base64 and zlib, for the XML files of VTK.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace sinew::mesh {

/// Decodes base64 until `max_bytes` are decoded or the text ends. White space is skipped, and
/// padding in the middle separates two blocks, as VTK writes it. Returns nothing if the text is not
/// valid base64.
/// @param text the encoded text.
/// @param max_bytes maximum number of bytes to decode.
std::optional<std::string> decode_base64(std::string_view text, std::size_t max_bytes);

/// Encodes base64 with padding and without line breaks.
/// @param bytes to encode.
std::string encode_base64(std::string_view bytes);

/// Decompresses one zlib stream of exactly `size` bytes. Returns nothing if it is damaged or of
/// another size. A size that zlib cannot reach (1032 : 1) is rejected before memory is allocated.
/// @param packed the compressed bytes.
/// @param size of the result.
std::optional<std::string> inflate(std::string_view packed, std::size_t size);

/// Compresses with zlib at its default level.
/// @param bytes to compress.
std::string deflate(std::string_view bytes);

}  // namespace sinew::mesh
