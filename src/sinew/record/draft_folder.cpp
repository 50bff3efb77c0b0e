#include "sinew/record/draft_folder.hpp"

#include <string>
#include <system_error>

#include "sinew/core/file.hpp"

namespace sinew::record {

DraftFolder::DraftFolder(const std::filesystem::path& folder) : path_(folder / ".sinew-new") {
  remove();
  std::error_code problem;
  std::filesystem::create_directory(path_, problem);
  if (problem) throw_unwritable(path_, problem.value());
}

bool DraftFolder::remove() {
  std::error_code problem;
  std::filesystem::remove_all(path_, problem);
  return !problem;
}

Error DraftFolder::named(const Error& error) const {
  const std::string start = path_.string() + '/';
  if (!error.place().file.starts_with(start)) return error;
  Location place = error.place();
  place.file = (path_.parent_path() / place.file.substr(start.size())).string();
  return {error.kind(), place, error.message(), error.remedy()};
}

}  // namespace sinew::record
