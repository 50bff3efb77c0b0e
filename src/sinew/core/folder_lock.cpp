#include "sinew/core/folder_lock.hpp"

#include <array>
#include <cerrno>
#include <string>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"

namespace sinew {

namespace {

// " (process 4711)", as the owner of the lock wrote it; empty if it did not.
std::string owner(int file) {
  std::array<char, 32> text{};
  const ssize_t size = pread(file, text.data(), text.size() - 1, 0);
  const std::string_view digits(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  const bool number =
      !digits.empty() && digits.find_first_not_of("0123456789") == std::string_view::npos;
  return number ? fmt::format(" (process {})", digits) : "";
}

// Whether the path still names the open file. Its last owner may have removed it before the lock
// was taken; then a third one may lock a new file of this name.
bool is_named(int file, const std::filesystem::path& path) {
  struct stat open_one {
  }, named{};
  return fstat(file, &open_one) == 0 && stat(path.c_str(), &named) == 0 &&
         open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : path_(folder / ".sinew-lock") {
  while (!take()) {
  }
  const std::string process = fmt::format("{}", getpid());
  // The number is for messages only: a disk without room for it is no reason to stop.
  if (ftruncate(file_, 0) == 0) (void)!pwrite(file_, process.data(), process.size(), 0);
}

bool FolderLock::take() {
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0 && errno == EACCES) file_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0) throw_unwritable(path_, errno);
  const bool locked = flock(file_, LOCK_EX | LOCK_NB) == 0;
  if (!locked && errno == EWOULDBLOCK) {
    const std::string who = owner(file_);
    close(file_);
    throw Error(ErrorKind::file_unwritable, {.file = path_.parent_path().string()},
                fmt::format("another run{} is being recorded into this folder", who),
                "wait until it has ended, or choose another folder");
  }
  if (!locked || is_named(file_, path_)) return true;
  close(file_);
  return false;
}

FolderLock::~FolderLock() {
  unlink(path_.c_str());  // while it is locked, so that nobody else's file is removed
  close(file_);
}

}  // namespace sinew
