/// @file
/// Where this program lies.
#pragma once

#include <filesystem>

namespace sinew::cli {

/// Empty where the system does not tell.
inline std::filesystem::path program_folder() {
  std::error_code problem;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", problem);
  return problem ? std::filesystem::path() : self.parent_path();
}

}  // namespace sinew::cli
