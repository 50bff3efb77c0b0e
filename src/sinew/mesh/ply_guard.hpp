/// @file
/// Checks that a PLY file is complete before another library parses it.
#pragma once

#include <string>
#include <string_view>

namespace sinew::mesh {

/// Checks header and body of a PLY file (text, or binary of either byte order): the header is
/// complete and known, every announced element is present, vertices have coordinates, and faces
/// refer to existing vertices. This is needed because the parser of assimp does not terminate on
/// some truncated files. Throws Error(malformed-file, truncated-file, size-limit,
/// index-out-of-range).
/// @param bytes the whole file.
/// @param name its name, for messages.
void require_whole_ply(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
