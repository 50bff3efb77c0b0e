#include "sinew/core/cache_folder.hpp"

#include <cstdlib>
#include <system_error>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"

namespace sinew {

namespace fs = std::filesystem;

fs::path cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::string() : std::string(value);
  };
  if (const std::string own = variable("XDG_CACHE_HOME"); !own.empty())
    return fs::path(own) / "sinew";
  const std::string home = variable("HOME");
  return home.empty() ? fs::path() : fs::path(home) / ".cache" / "sinew";
}

std::optional<std::string> recall_result(const std::string& name) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return std::nullopt;
  try {
    return read_file(folder / name);
  } catch (const Error&) {
    return std::nullopt;
  }
}

void keep_result(const std::string& name, std::string_view text) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return;
  std::error_code problem;
  fs::create_directories((folder / name).parent_path(), problem);
  if (problem) return;
  try {
    write_file(folder / name, text);
  } catch (const Error&) {
    return;
  }
}

}  // namespace sinew
