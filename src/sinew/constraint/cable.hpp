/// @file
/// A cable that slides through via points, with or without Coulomb friction at them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// A cable: one row for its pull and, with friction, one row for each point between its ends.
///
/// The effort of the first row is the tension T_0 >= 0 (N) at the pull point. Its motion is
/// delta = L_0 - L (m), the length pulled out there. With u_i the unit vector of segment i,
/// d(delta)/dx_i = u_i - u_{i-1}: H^T T_0 is the force T_0 (u_i - u_{i-1}) that a taut frictionless
/// cable exerts on via point i. A segment of length l contributes -(I - u u^T)/l to the Hessian of
/// delta, for the relative motion of its two ends.
///
/// With friction, each point i that the cable slides through has its own row. The length s_i that
/// has passed the point towards the pull point is the length that the segments behind it have lost:
///   sum_i T_i delta_i = T_0 s_0 - sum_i F_i s_i,   F_i = T_{i-1} - T_i, s_0 = delta.
/// The effort of the row is the friction force F_i (N). Its motion is -s_i (m) up to a constant:
/// the length behind the point. Its directions are minus those of the cable behind the point.
/// Coulomb's law for a rope around a bollard (Euler 1762) limits F_i: T_i <= T_{i-1} e^(mu theta_i)
/// and T_{i-1} <= T_i e^(mu theta_i), where theta_i is the angle by which the cable turns at the
/// point.
class Cable : public Constraint {
 public:
  /// @param name for messages.
  /// @param points via points from the pull point to the anchored end. The last one is fixed to the
  ///   body; the cable slides through the others.
  /// @param world_pull_point where the cable enters, if that point is fixed to the world, (3,) m;
  ///   absent if points.front() is the pull point itself.
  /// @param points_at_rest positions of all points at rest, pull point first: (n, 3) m.
  /// @param friction whether the points that the cable slides through have rows.
  /// Throws Error: too-few-points for fewer than two points, degenerate-cable for coincident ones.
  Cable(std::string name, std::vector<mechanics::MaterialPoint> points,
        std::optional<Vector3> world_pull_point, const Points& points_at_rest,
        bool friction = false);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void geometric_stiffness(const Configuration& configuration, std::span<const double> effort,
                           std::span<mechanics::StiffnessPair> stiffness_pairs) const override;

  void describe(PartVisitor& visitor) const override {
    visitor.add(pull_point_, rest_length_, friction_);
  }

  /// True while every segment is under tension.
  bool stiffens(std::span<const double> effort) const override;

  /// The points in bodies, in their order from the pull point.
  const std::vector<mechanics::MaterialPoint>& material_points() const { return points_; }
  /// The pull point, if it is fixed to the world, (3,) m.
  const std::optional<Vector3>& pull_point() const { return pull_point_; }
  /// L_0, m.
  double rest_length() const { return rest_length_; }
  /// Present length L, m.
  double length(const Configuration& configuration) const;
  /// Number of points between the ends.
  int via_count() const { return point_count() - 2; }
  /// Angle by which the cable turns at a point between its ends, rad.
  /// @param configuration of all bodies. @param via 0 .. via_count() - 1, from the pull point.
  double turn(const Configuration& configuration, int via) const;
  /// Sum of turn() over all points between the ends, rad.
  double wrap(const Configuration& configuration) const;
  /// Row of the friction at a point between the ends. Requires friction.
  int friction_row(int via) const { return first_row_ + 1 + via; }
  /// Tension of every segment, pull point first, (via_count() + 1,) N.
  /// @param effort (rows,) of the world.
  std::vector<double> tensions(std::span<const double> effort) const;
  /// Present positions of all points, pull point first; (n, 3) m.
  Points points(const Configuration& configuration) const;

 private:
  int point_count() const { return static_cast<int>(points_.size()) + (pull_point_ ? 1 : 0); }
  Vector3 point(const Configuration& configuration, int i) const;
  void linearise_friction(const Configuration& configuration, mechanics::RowValues& values) const;

  std::vector<mechanics::MaterialPoint> points_;
  std::optional<Vector3> pull_point_;
  double rest_length_ = 0.0;
  bool friction_ = false;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
