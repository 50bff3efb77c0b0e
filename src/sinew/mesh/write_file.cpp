#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/mesh/write.hpp"

namespace sinew::mesh {

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  static std::atomic<unsigned> counter{0};  // two threads may write the same file at once
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

}  // namespace sinew::mesh
