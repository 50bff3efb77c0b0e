/// @file
/// A lock on a folder that a program writes to for some time.
#pragma once

#include <filesystem>

namespace sinew {

/// While it exists, no other lock on the folder can be made, in this process or another one. It is
/// kept by a file, `.sinew-lock`, which is removed with it. The system releases the lock of a
/// process that ends in any way; the file that a killed process leaves does not lock. Where the
/// file system has no locks, there is none.
class FolderLock {
 public:
  /// Throws Error(file-unwritable) if the folder is locked or cannot be written to, and
  /// Error(recording-failed) if the disk is full.
  /// @param folder exists.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  bool take();

  std::filesystem::path path_;
  int file_ = -1;  // descriptor
};

}  // namespace sinew
