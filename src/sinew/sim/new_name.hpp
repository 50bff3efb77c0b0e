/// @file
/// Names that are given once.
#pragma once

#include <algorithm>
#include <string>

namespace sinew {
struct Location;
}

namespace sinew::sim {

/// Throws Error(duplicate-key). @param kind of the parts, in the plural: "loads". @param name,place
///   of the part that has a name again, and where it is written.
[[noreturn]] void throw_same_name(const char* kind, const std::string& name, const Location& place);

/// Throws Error(duplicate-key) where a part has the name already.
/// @param parts,name_of of one kind, and where a part has its name. @param kind see
///   throw_same_name(). @param name,place of the new part.
template <class Parts, class NameOf>
void check_new_name(const Parts& parts, NameOf name_of, const char* kind, const std::string& name,
                    const Location& place) {
  if (std::ranges::find(parts, name, name_of) != parts.end()) throw_same_name(kind, name, place);
}

}  // namespace sinew::sim
