/// @file
/// Check that names are unique.
#pragma once

#include <algorithm>
#include <string>

namespace sinew {
struct Location;
}

namespace sinew::model {

/// Throws Error(duplicate-key). @param kind of the parts, in the plural: "loads".
/// @param name,place of the part with the duplicate name, and its source location.
[[noreturn]] void throw_same_name(const char* kind, const std::string& name, const Location& place);

/// Throws Error(duplicate-key) if a part already has the name.
/// @param parts of one kind. @param name_of projection from a part to its name.
/// @param kind see throw_same_name(). @param name,place of the new part.
template <class Parts, class NameOf>
void check_new_name(const Parts& parts, NameOf name_of, const char* kind, const std::string& name,
                    const Location& place) {
  if (std::ranges::find(parts, name, name_of) != parts.end()) throw_same_name(kind, name, place);
}

}  // namespace sinew::model
