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

/// Throws the error of a file or folder that cannot be written: recording-failed, a failed run, if
/// the disk is full or broken; else file-unwritable, which is wrong input.
/// @param path the file or folder. @param reason as in errno.
[[noreturn]] void throw_unwritable(const std::filesystem::path& path, int reason);

/// The name of a file beside another one, in the same folder and hence on the same disk. Different
/// for every call of every process.
/// @param path of the other file.
std::filesystem::path draft_beside(const std::filesystem::path& path);

/// Renames a file, which replaces another one of the new name. Throws what throw_unwritable()
/// throws.
/// @param from,to its names, on the same disk.
void replace_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// Writes a file atomically: writes a temporary file in the same folder and renames it. Throws
/// what throw_unwritable() throws; the old file is then as it was.
/// @param path the file.
/// @param bytes its content.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace sinew
