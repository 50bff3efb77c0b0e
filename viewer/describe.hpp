/// @file
/// What a page is told of a robot before the first frame.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sinew/fem/element_fields.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/observables.hpp"

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
/// Which of list_fields() are wanted.
using FieldChoice = std::vector<bool>;
/// (fields,) values of list_fields() at a node, from the elements round it alone; NaN where the
/// body has no such field. @param body,simulation one of its bodies. @param node of its mesh.
std::vector<double> fields_at(const mechanics::Body& body, const sim::Simulation& simulation,
                              NodeId node);

/// Whether the numbers of an observable are among Frame::signals. Signals have the order of the
/// list.
bool is_signal(const sim::Observable& observable);

/// The outside of a body's mesh, its vertices numbered anew.
DisplaySurface surface_of(const mesh::Mesh& mesh);

/// Everything at once. @param robot what is shown. @param observables of its simulation.
Description describe(const scene::Robot& robot, const sim::Observables& observables);

}  // namespace sinew::viewer
