/// @file
/// What touches what, and how hard: contacts as a user reads them.
#pragma once

#include "sinew/core/types.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::sim {

/// One point that may touch, after the last step.
struct ContactPoint {
  Vector3 position = Vector3::Zero();        ///< (3,) m
  double gap = 0.0;                          ///< m, exact, negative inside
  Vector3 normal = Vector3::UnitZ();         ///< (3,) out of the surface, of the step
  double normal_force = 0.0;                 ///< N, >= 0, on the body along `normal`
  Vector3 friction_force = Vector3::Zero();  ///< (3,) N on the body, across `normal`
  /// open: no force; slip: friction at its limit; stick: within it.
  qp::ContactState state = qp::ContactState::open;
};

/// All points of one contact together.
struct ContactSum {
  Vector3 force = Vector3::Zero();  ///< (3,) N, on the body
  double normal_force = 0.0;        ///< N, sum over the points
  double friction_force = 0.0;      ///< N, sum of the points' magnitudes
  double smallest_gap = 0.0;        ///< m
  int sticking = 0, slipping = 0;   ///< points
};

}  // namespace sinew::sim
