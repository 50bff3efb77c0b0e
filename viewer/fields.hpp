/// @file
/// Fields by which bodies are coloured, and values at a node or an element.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sinew/fem/element_fields.hpp"
#include "sinew/sim/simulation.hpp"

#include "frame.hpp"

namespace sinew::mechanics {
class Body;
}

namespace sinew::viewer {

/// A field by which bodies can be coloured: the displacement or, for finite elements, a field of
/// the elements or the force of the actuators on each node.
struct FieldInfo {
  std::string name, label, unit, description;
  /// Computes the values (n,) at all nodes; zero if the body does not have the field. The arguments
  /// are a body, its simulation, and the nodal mean of the body (null for one without elements).
  std::function<std::vector<double>(const mechanics::Body&, const sim::Simulation&,
                                    const fem::NodalMean*)>
      values;
};
/// All fields, in the order of Description::fields.
const std::vector<FieldInfo>& list_fields();
/// Values of list_fields() at a node or an element, computed only from the elements around it; NaN
/// where there is no value.
/// @param simulation of the body. @param at an existing node or element. @param materials of the
/// elements, DisplaySurface::materials.
PickFrame values_of(const sim::Simulation& simulation, const Picked& at,
                    const std::vector<int>& materials);

}  // namespace sinew::viewer
