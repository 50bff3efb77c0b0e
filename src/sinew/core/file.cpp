#include "sinew/core/file.hpp"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

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

void throw_unwritable(const std::filesystem::path& path, int reason) {
  const bool disk = reason == ENOSPC || reason == EDQUOT || reason == EIO || reason == EFBIG;
  throw Error(disk ? ErrorKind::recording_failed : ErrorKind::file_unwritable,
              {.file = path.string()},
              fmt::format("this cannot be written: {}", std::generic_category().message(reason)),
              disk ? "check that the disk is not full, or choose another one"
                   : "check that its folder exists and may be written to, or choose another one");
}

std::filesystem::path draft_beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};  // two threads may write the same file at a time
  std::filesystem::path draft = path;
  draft += fmt::format(".{}-{}.tmp", getpid(), counter++);
  return draft;
}

void replace_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code problem;
  std::filesystem::rename(from, to, problem);
  if (problem) throw_unwritable(to, problem.value());
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path draft = draft_beside(path);
  int reason = 0;
  {
    errno = 0;
    std::ofstream stream(draft, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) reason = errno != 0 ? errno : EIO;
  }
  std::error_code problem;
  if (reason == 0) std::filesystem::rename(draft, path, problem);
  if (problem) reason = problem.value();
  if (reason == 0) return;
  std::filesystem::remove(draft, problem);
  throw_unwritable(path, reason);
}

}  // namespace sinew
