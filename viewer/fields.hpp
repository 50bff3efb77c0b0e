/// @file
/// What bodies can be coloured by, and what is told of a node or an element.
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

/// Fields that bodies can be coloured by: the displacement, and of finite elements those of the
/// elements and the force of the actuators on each node. In the order of Description::fields.
struct FieldInfo {
  std::string name, label, unit, description;
  /// (n,) at all nodes; zero where the body has no such field. @param body,simulation one of its
  /// bodies. @param mean of that body; null of one without elements.
  std::function<std::vector<double>(const mechanics::Body&, const sim::Simulation&,
                                    const fem::NodalMean*)>
      values;
};
const std::vector<FieldInfo>& list_fields();
/// What is known of a node or an element, from the elements round it alone: its values of
/// list_fields(), NaN where there is none.
/// @param simulation where it is. @param at which; its body has it. @param materials of the body's
///   elements, DisplaySurface::materials.
PickFrame values_of(const sim::Simulation& simulation, const Picked& at,
                    const std::vector<int>& materials);

}  // namespace sinew::viewer
