/// @file
/// A cable that slides through via points, with or without Coulomb friction at them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// First row: effort = tension T_0 >= 0 (N) at the pull point, delta = L_0 - L (m), the length
/// pulled out there. With u_i the unit vector of segment i, d(delta)/dx_i = u_i - u_{i-1}, so that
/// H^T T_0 is the force T_0 (u_i - u_{i-1}) which a taut frictionless cable puts on via point i.
/// The Hessian of the length of a segment of length l is d2(delta) = -(I - u u^T)/l on its two
/// ends' relative motion.
///
/// With friction, each point i that it slides through has a row more. The length s_i that has
/// passed the point towards the pull point is what the segments behind it lost, so that
///   sum_i T_i delta_i = T_0 s_0 - sum_i F_i s_i,   F_i = T_{i-1} - T_i, s_0 = delta:
/// the row's effort is the friction force F_i (N), its motion -s_i (m), and its directions are
/// those of the rest of the cable behind the point, with the other sign. What F_i may be is
/// Coulomb's law at a rope over a bollard (Euler 1762), T_i <= T_{i-1} e^(mu theta_i) and the other
/// way round, with theta_i the angle by which the cable turns there.
class Cable : public Constraint {
 public:
  /// @param name for messages.
  /// @param points via points from the pull point's side to the anchored end; the last one is fixed
  ///   to the body, the others slide.
  /// @param world_pull_point where the cable enters when that is fixed to the world, (3,) m; absent
  ///   when points.front() is the pull point itself.
  /// @param points_at_rest positions of all points at rest, pull point first: (n, 3) m.
  /// @param friction whether the points that it slides through have rows.
  /// Throws Error(too_few_points) under two points, Error(degenerate_cable) for coincident ones.
  Cable(std::string name, std::vector<mechanics::MaterialPoint> points,
        std::optional<Vector3> world_pull_point, const Points& points_at_rest,
        bool friction = false);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void geometric_stiffness(const Configuration& configuration, std::span<const double> effort,
                           std::span<mechanics::StiffnessPair> stiffness_pairs) const override;

  void add_to(ValueHash& hash) const override { hash.add(pull_point_, rest_length_, friction_); }

  /// While every segment is under tension.
  bool stiffens(std::span<const double> effort) const override;

  /// L_0, m.
  double rest_length() const { return rest_length_; }
  /// L now, m.
  double length(const Configuration& configuration) const;
  /// Points between its ends.
  int via_count() const { return point_count() - 2; }
  /// The angle by which it turns at one of them, 0 .. via_count() - 1 from the pull point on, rad.
  double turn(const Configuration& configuration, int via) const;
  /// Sum of those angles, rad (its wrap).
  double wrap(const Configuration& configuration) const;
  /// Row of the friction at a point between its ends. Only with friction.
  int friction_row(int via) const { return first_row_ + 1 + via; }
  /// Tension of every segment, pull point first, (via_count() + 1,) N.
  /// @param effort (rows,) of the world.
  std::vector<double> tensions(std::span<const double> effort) const;
  /// All points now, pull point first; (n, 3) m.
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
