/// @file
/// Whole files as bytes.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace sinew {

/// The bytes of a file. Throws Error(file-not-found, file-unreadable).
/// @param path the file.
std::string read_file(const std::filesystem::path& path);

/// Writes a file whole or not at all: first beside it under another name, then renamed. Throws
/// Error(file-unwritable).
/// @param path the file.
/// @param bytes its content.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace sinew
