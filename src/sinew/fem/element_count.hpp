/// @file
/// Number of finite elements of a body, by kind.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/fem/fem_model.hpp"

namespace sinew::fem {

/// Number of elements of one kind.
struct ElementCount {
  std::string_view element;  ///< its name in scenes: "tet4", "tet4-patch", "tet10", "hex8"
  int count = 0;             ///< > 0
};

/// Counts the elements of each kind that occurs; tetrahedra first.
std::vector<ElementCount> count_elements(const FemModel& model);

/// Text such as "2639 tet10 elements" or "12 tet4 and 30 hex8 elements".
std::string describe_elements(const FemModel& model);

}  // namespace sinew::fem
