/// @file
/// What a weld carries.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::sim {

class Simulation;

/// The forces of a weld's points on its second body, as one; the first body gets the opposite.
struct WeldLoad {
  Vector3 centre = Vector3::Zero();  ///< (3,) m, mean of the points now
  Vector3 force = Vector3::Zero();   ///< (3,) N, on the second body
  Vector3 moment = Vector3::Zero();  ///< (3,) N m, about the centre
  double gap = 0.0;                  ///< m, largest distance of two points that should be one
};

/// After the last step. @param weld of Model::welds().
WeldLoad weld_load(const Simulation& simulation, int weld);

}  // namespace sinew::sim
