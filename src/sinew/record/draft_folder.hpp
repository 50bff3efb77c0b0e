/// @file
/// The files of a run that has no frame yet.
#pragma once

#include <filesystem>

#include "sinew/core/error.hpp"

namespace sinew::record {

/// A hidden folder within that of a record, for files that will replace those of an older run. It
/// is removed with this. The lock of the record's folder must be held: a hidden folder that is
/// found there belongs to a run that was killed.
class DraftFolder {
 public:
  /// Makes the folder. Throws what throw_unwritable() throws.
  /// @param folder of the record.
  explicit DraftFolder(const std::filesystem::path& folder);
  ~DraftFolder() { remove(); }
  DraftFolder(const DraftFolder&) = delete;
  DraftFolder& operator=(const DraftFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

  /// Removes the folder. @return whether it is gone.
  bool remove();

  /// The error, with the file that was to be replaced as its place. @param error about a draft.
  Error named(const Error& error) const;

 private:
  std::filesystem::path path_;
};

}  // namespace sinew::record
