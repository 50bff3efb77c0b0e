/// @file
/// The folder of the running program.
#pragma once

#include <filesystem>

namespace sinew::cli {

/// The folder of the running program; empty if the system does not provide it.
inline std::filesystem::path program_folder() {
  std::error_code problem;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", problem);
  return problem ? std::filesystem::path() : self.parent_path();
}

}  // namespace sinew::cli
