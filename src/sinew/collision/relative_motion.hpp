/// @file
/// Relative motion of two convex sets of linearly moving points: separating planes with bounds on
/// rounding errors.
#pragma once

#include <array>

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// The four differences d_j of the points of two sets. The sets meet when the origin is in the
/// convex hull of the d_j: d_j = v - f_j for a vertex and a triangle (the last one twice),
/// d = a_i - b_k for two edges. All d_j are linear in the time, which runs from 0 to 1.
///
/// A plane with a fixed normal n separates the sets while n.d_j > 0 for all j. Each n.d_j has a
/// lower bound at both ends, whatever the rounding. Between the ends the bound is linear, too,
/// which gives exactly how long the plane separates the sets.
class RelativeMotion {
 public:
  using Lanes = Eigen::Array<double, 4, 1>;

  /// @param separation m, >= 0: the distance that counts as a meeting.
  explicit RelativeMotion(double separation) : separation_(separation) {}

  /// Sets d_j. @param j 0 to 3.
  /// @param start,end (3,) m, each the rounded difference of two exact points.
  void set(int j, const Vector3& start, const Vector3& end) {
    for (std::size_t k = 0; k < 3; ++k) {
      start_[k][j] = start[static_cast<Eigen::Index>(k)];
      end_[k][j] = end[static_cast<Eigen::Index>(k)];
    }
  }

  /// Whether all differences are finite; if not, the other functions are meaningless.
  bool finite() const;

  /// Whether a plane normal to a coordinate axis separates the sets all the time.
  bool apart_along_axis() const;

  /// The time up to which the plane with normal n separates the sets without interruption: more
  /// than 1 if it separates them to the end, `time` if it does not separate them now.
  /// @param normal (3,), of any length. @param time from 0 to 1.
  double separated_until(const Vector3& normal, double time) const;

  /// d_j at a time, m, subject to rounding.
  Vector3 at(int j, double time) const;

 private:
  std::array<Lanes, 3> start_, end_;  // by coordinate
  double separation_;
};

}  // namespace sinew::collision
