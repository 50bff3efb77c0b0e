/// @file
/// A cable that slides without friction through via points: one tension along its whole length.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// One row: effort = tension T >= 0 (N), delta = L_0 - L (m), the length pulled out at the pull
/// point. With u_i the unit vector of segment i, d(delta)/dx_i = u_i - u_{i-1}, so that H^T T is
/// the force T (u_i - u_{i-1}) which a taut frictionless cable puts on via point i. The curvature
/// of a segment of length l is d2(delta) = -(I - u u^T)/l on its two ends' relative motion.
class Cable : public Constraint {
 public:
  /// @param name for messages.
  /// @param points via points from the pull point's side to the anchored end; the last one is fixed
  ///   to the body, the others slide.
  /// @param world_pull_point where the cable enters when that is fixed to the world, (3,) m; absent
  ///   when points.front() is the pull point itself.
  /// @param placement_at_rest positions of all points at rest, pull point first: (n, 3) m.
  /// Throws Error(too_few_points) under two points, Error(degenerate_cable) for coincident ones.
  Cable(std::string name, std::vector<mechanics::MaterialPoint> points,
        std::optional<Vector3> world_pull_point, const Points& placement_at_rest);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::RowCurvature>& curvatures) override;
  void linearise(const Placement& placement, mechanics::RowValues& values) const override;
  void curve(const Placement& placement,
             std::span<mechanics::RowCurvature> curvatures) const override;

  /// L_0, m.
  double rest_length() const { return rest_length_; }
  /// L now, m.
  double length(const Placement& placement) const;
  /// Sum of the angles by which the cable turns at its via points, rad (its wrap).
  double wrap(const Placement& placement) const;
  /// All points now, pull point first; (n, 3) m.
  Points points(const Placement& placement) const;

 private:
  int point_count() const { return static_cast<int>(points_.size()) + (pull_point_ ? 1 : 0); }
  Vector3 point(const Placement& placement, int i) const;

  std::vector<mechanics::MaterialPoint> points_;
  std::optional<Vector3> pull_point_;
  double rest_length_ = 0.0;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
