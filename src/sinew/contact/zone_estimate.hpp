/// @file
/// Estimate of the change in a zone's forces if each of its points obeyed the contact laws by
/// itself.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::contact {

/// A point of a zone at the end of a step.
struct ZonePoint {
  Vector3 place = Vector3::Zero();   ///< m
  Matrix3 frame;                     ///< columns: the normal and two tangents
  Vector3 force = Vector3::Zero();   ///< N, in its frame, its part of the zone's resultant
  Vector3 motion = Vector3::Zero();  ///< m, in its frame: gap and slip
  double friction = 0.0;             ///< Coulomb's coefficient
};

/// Estimates the change by a local problem (Bank & Weiser, Math. Comp. 44 (1985) 283), in which the
/// other zones are unchanged and forces f+ replace f:
///   u+ = u + B (f+ - f),   0 <= g+ _|_ r_n+ >= 0,   |r_t+| <= mu r_n+ against u_t+,
/// B_kl = (b_n n n^T + b_t (1 - n n^T)) / sqrt(|x_k - x_l|^2 + a^2) as in ContactZones, with b_n
/// and b_t from the zone's compliance along and across the normal. Solved by block Gauss-Seidel.
/// Work space is reused from zone to zone.
class ZoneEstimate {
 public:
  /// @param points of the zone, each with a force or an overlap.
  /// @param compliance (3,) m/N, of the resultant in the frame of its points. @param spread a, m.
  /// @return (3,) N: the sum of f+ - f, in world axes.
  Vector3 force_change(const std::vector<ZonePoint>& points, const Vector3& compliance,
                       double spread);

 private:
  void begin(const std::vector<ZonePoint>& points, const Vector3& compliance, double spread);
  Vector3 motion(const std::vector<ZonePoint>& points, std::size_t i) const;
  double relax(const std::vector<ZonePoint>& points, std::size_t i);

  double total_ = 0.0;                      // N, sum of the normal forces
  double normal_ = 0.0, tangential_ = 0.0;  // b_n and b_t, m^2/N
  std::vector<double> kernel_;              // (n, n) 1/m
  std::vector<Vector3> change_;             // (n,) N, in world axes
};

}  // namespace sinew::contact
