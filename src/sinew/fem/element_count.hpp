/// @file
/// The finite elements of a body by their names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/fem/fem_model.hpp"

namespace sinew::fem {

/// How many elements of one kind.
struct ElementCount {
  std::string_view element;  ///< as scenes name it: "tet4", "tet4-patch", "tet10", "hex8"
  int count = 0;             ///< > 0
};

/// Tetrahedra first.
std::vector<ElementCount> count_elements(const FemModel& model);

/// "2639 tet10 elements", "12 tet4 and 30 hex8 elements".
std::string describe_elements(const FemModel& model);

}  // namespace sinew::fem
