/// @file
/// Makes sure that a PLY file is whole before another library parses it.
#pragma once

#include <string>
#include <string_view>

namespace sinew::mesh {

/// Walks through header and body of a PLY file (text, binary of either order) and checks that the
/// header is complete and known, that every element it announces is there, that vertices have
/// coordinates, and that faces name vertices that exist. assimp's parser does not end on some files
/// that are cut short. Throws Error(malformed-file, truncated-file, size-limit,
/// index-out-of-range).
/// @param bytes the whole file.
/// @param name its name, for messages.
void require_whole_ply(std::string_view bytes, const std::string& name);

}  // namespace sinew::mesh
