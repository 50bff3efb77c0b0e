/// @file
/// States of contacts: which points touch, and their forces.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/core/types.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::contact {

/// The body whose points may touch and, for a contact between bodies, the body whose surface they
/// may touch. @param model that contains the contact. @param contact index of Model::contacts().
std::vector<std::string> touching_bodies(const model::Model& model, int contact);

/// State of one contact point after the last step. Where points are searched for in every step,
/// those that were not found have neither position nor gap nor normal: these are NaN.
struct ContactPoint {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  Vector3 position = Vector3::Constant(kUnknown);  ///< (3,) m
  double gap = kUnknown;                           ///< m, exact, negative inside the surface
  Vector3 normal = Vector3::Constant(kUnknown);    ///< (3,) outward normal used by the step
  double normal_force = 0.0;                       ///< N, >= 0, on the body, along `normal`
  Vector3 friction_force = Vector3::Zero();  ///< (3,) N, on the body, tangential to the surface
  /// open: no force; slip: friction at its limit; stick: within it.
  qp::ContactState state = qp::ContactState::open;

  /// Whether the point was found.
  bool is_measured() const { return !std::isnan(gap); }
};

/// The smallest gap of a contact.
struct ContactGap {
  double value = ContactPoint::kUnknown;  ///< m; NaN if the search found nothing to measure
  double above = ContactPoint::kUnknown;  ///< m: then, the gap is larger than this; else NaN
};

/// Resultant of all points of one contact.
struct ContactResultant {
  Vector3 force = Vector3::Zero();               ///< (3,) N, on the body
  double normal_force = 0.0;                     ///< N, sum over the points
  double friction_force = 0.0;                   ///< N, sum of the points' magnitudes
  double smallest_gap = ContactPoint::kUnknown;  ///< m; NaN if it was not measured
  double gap_above = ContactPoint::kUnknown;     ///< m: then, it is larger than this; else NaN
  int sticking = 0, slipping = 0;                ///< numbers of points

  /// Adds a point to the resultant. @param point of the contact.
  void add(const ContactPoint& point) {
    if (!point.is_measured()) return;
    force += point.normal_force * point.normal + point.friction_force;
    normal_force += point.normal_force;
    friction_force += point.friction_force.norm();
    smallest_gap = std::fmin(smallest_gap, point.gap);
    sticking += point.state == qp::ContactState::stick ? 1 : 0;
    slipping += point.state == qp::ContactState::slip ? 1 : 0;
  }
};

/// All points of one contact at one time.
struct ContactSnapshot {
  Eigen::Isometry3d pose =
      Eigen::Isometry3d::Identity();  ///< of the surface, relative to the scene
  std::vector<ContactPoint> points;
};

}  // namespace sinew::contact
