/// @file
/// The hydrostatic pressure of liquids outside a body or in its chambers.
#pragma once

#include <optional>
#include <vector>

#include "sinew/fem/loads.hpp"

namespace sinew::fem {
class HasElements;
}

namespace sinew::sim {

/// Hydrostatic pressure under the body's gravity. Without a level, it is zero at the centre of the
/// faces: a uniform pressure would only compress the body.
/// @param body with the faces. @param faces of its mesh. @param density kg/m^3.
/// @param level m, height against gravity.
fem::PressureLoad hydrostatic(const fem::HasElements& body, const std::vector<mesh::Face>& faces,
                              double density, std::optional<double> level);

}  // namespace sinew::sim
