#include "sinew/record/hdf5_handle.hpp"

#include <string_view>

namespace sinew::record {

std::string hdf5_reason() {
  std::string reason;
  const H5E_walk2_t take = [](unsigned, const H5E_error2_t* entry, void* text) -> herr_t {
    if (entry->desc != nullptr) *static_cast<std::string*>(text) = entry->desc;
    return 1;  // the first entry is the innermost: no need to go on
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take, &reason);
  // The message of the system is the useful part: "..., error message = 'No space left', ...".
  constexpr std::string_view kMark = "error message = '";
  if (const auto at = reason.find(kMark); at != std::string::npos) {
    const auto begin = at + kMark.size();
    return reason.substr(begin, reason.find('\'', begin) - begin);
  }
  return reason.empty() ? "no reason given" : reason;
}

}  // namespace sinew::record
