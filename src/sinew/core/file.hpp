/// @file
/// Reading and writing of whole files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sinew {

/// Reads the bytes of a file. Throws Error(file-not-found, file-unreadable).
/// @param path the file.
std::string read_file(const std::filesystem::path& path);

/// Writes a file atomically: writes a temporary file in the same folder and renames it. Throws
/// Error(file-unwritable).
/// @param path the file.
/// @param bytes its content.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace sinew
