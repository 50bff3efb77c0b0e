/// @file
/// The pressure of liquids at rest, on the outside of a body or in its chambers.
#pragma once

#include <optional>
#include <vector>

#include "sinew/fem/loads.hpp"

namespace sinew::fem {
class HasElements;
}

namespace sinew::sim {

/// Under the body's gravity. Without a level it is zero at the middle of the faces: what a depth
/// adds alike everywhere only compresses.
/// @param body,faces of its mesh. @param density kg/m^3. @param level m, height against gravity.
fem::PressureLoad hydrostatic(const fem::HasElements& body, const std::vector<mesh::Face>& faces,
                              double density, std::optional<double> level);

}  // namespace sinew::sim
