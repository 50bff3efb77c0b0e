/// @file
/// The hydrostatic pressure of liquids outside a body or in its chambers.
#pragma once

#include <optional>
#include <vector>

#include "sinew/mechanics/loads.hpp"

namespace sinew::mechanics {
class BearsLoads;
}

namespace sinew::builder {

/// Hydrostatic pressure under the body's gravity. Without a level, it is zero at the centre of the
/// faces: a uniform pressure would only compress the body.
/// @param body with the faces. @param faces of its mesh. @param density kg/m^3.
/// @param level m, height against gravity.
mechanics::PressureLoad hydrostatic(const mechanics::BearsLoads& body,
                                    const std::vector<mesh::Face>& faces, double density,
                                    std::optional<double> level);

}  // namespace sinew::builder
