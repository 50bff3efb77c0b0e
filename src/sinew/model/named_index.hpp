/// @file
/// Lookup of parts by name, with suggestions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sinew::model {

/// Throws Error(unknown-name) with the nearest of the known names, or all of them.
/// @param name that is unknown. @param what of it is: "sensor". @param known names.
[[noreturn]] void throw_unknown_name(std::string_view name, const char* what,
                                     const std::vector<std::string>& known);

/// Index of the part with a name. Throws as throw_unknown_name().
/// @param parts of one kind. @param name of the part. @param what see throw_unknown_name().
/// @param name_of function from a part to its name.
template <class Parts, class NameOf>
int index_of_name(const Parts& parts, std::string_view name, const char* what, NameOf name_of) {
  std::vector<std::string> known;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (name_of(parts[i]) == name) return static_cast<int>(i);
    known.push_back(name_of(parts[i]));
  }
  throw_unknown_name(name, what, known);
}

}  // namespace sinew::model
