#include "sinew/core/file.hpp"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/error.hpp"

namespace sinew {

std::string read_file(const std::filesystem::path& path) {
  std::error_code problem;
  const auto status = std::filesystem::status(path, problem);
  if (!std::filesystem::exists(status)) {
    throw Error(
        ErrorKind::file_not_found, {.file = path.string()}, "there is no such file",
        fmt::format("paths are relative to {}", std::filesystem::current_path(problem).string()));
  }
  std::ifstream stream(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(status) || !stream) {
    throw Error(ErrorKind::file_unreadable, {.file = path.string()},
                std::filesystem::is_directory(status) ? "this is a folder, not a file"
                                                      : "the file cannot be opened",
                "check the path and its permissions");
  }
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(path, problem)), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  static std::atomic<unsigned> counter{0};  // two threads may write the same file at a time
  std::filesystem::path draft = path;
  draft += fmt::format(".{}-{}.tmp", getpid(), counter++);
  std::error_code problem;
  errno = 0;
  {
    std::ofstream stream(draft, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) problem = std::error_code(errno != 0 ? errno : EIO, std::generic_category());
  }
  if (!problem) std::filesystem::rename(draft, path, problem);
  if (!problem) return;
  std::error_code ignored;
  std::filesystem::remove(draft, ignored);
  throw Error(ErrorKind::file_unwritable, {.file = path.string()},
              fmt::format("the file cannot be written: {}", problem.message()),
              "check that its folder exists, may be written to and has space");
}

}  // namespace sinew
