/// @file
/// What touches what, and how hard: contacts as a user reads them.
#pragma once

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/types.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::sim {

class Model;

/// The body whose points may touch, and the body that they may touch; of a surface of the world the
/// first alone. @param model of both. @param contact of Model::contacts().
std::vector<std::string> touching_bodies(const Model& model, int contact);

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
struct ContactResultant {
  Vector3 force = Vector3::Zero();  ///< (3,) N, on the body
  double normal_force = 0.0;        ///< N, sum over the points
  double friction_force = 0.0;      ///< N, sum of the points' magnitudes
  double smallest_gap = std::numeric_limits<double>::infinity();  ///< m
  int sticking = 0, slipping = 0;                                 ///< points

  /// @param point to be counted in.
  void add(const ContactPoint& point) {
    force += point.normal_force * point.normal + point.friction_force;
    normal_force += point.normal_force;
    friction_force += point.friction_force.norm();
    smallest_gap = std::min(smallest_gap, point.gap);
    sticking += point.state == qp::ContactState::stick ? 1 : 0;
    slipping += point.state == qp::ContactState::slip ? 1 : 0;
  }
};

/// One contact at one instant.
struct ContactSnapshot {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the surface, from the scene's
  std::vector<ContactPoint> points;
};

}  // namespace sinew::sim
