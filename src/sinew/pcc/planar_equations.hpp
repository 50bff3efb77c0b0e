/// @file
/// The equations of motion of an arm whose segments all bend in one plane, with their first
/// derivatives in closed form: ArmEquations::linearise() of such arms.

// Vectors of the plane are complex numbers, along the base's axis + i towards its x. Segment n
// begins turned by u_n = e^(i phi_n), phi_n = sum_(k<n) theta_k, and a point of it, at the
// fraction f of its arc, lies at
//   x = o_n + u_n f L_n E(f theta_n),   E(a) = (e^(ia) - 1)/(ia),
// o_n the start and e_n the end of its bend. With J_k = dx/dtheta_k and g = L E',
//   J_k = i (x - e_k) + u_k g_k                      for k < n,   J_n = u_n f^2 L_n E',
//   d2x/dtheta_k dtheta_j = i J_max(k,j)              for k != j,
//   d2x/dtheta_k^2 = i J_k + u_k (g'_k - i g_k)       for k < n,
// since theta_k turns all beyond e_k. By the same rule, with Omega_k = sum_(j<k) theta'_j and
// alpha_k = theta''_k + 2 i Omega_k theta'_k,
//   x''             = sum_k J_k alpha_k + x_kk theta'_k^2,
//   dx''/dtheta_m   = J_m (i sum_(k<m) alpha_k - sum_(k<m) theta'_k^2) + x_mm alpha_m
//                     + x_mmm theta'_m^2 + i sum_(k>m) (J_k alpha_k + x_kk theta'_k^2),
//   dx''/dtheta'_m  = 2 (x_mm theta'_m + i J_m Omega_m + i sum_(k>m) J_k theta'_k).
#pragma once

#include <memory>
#include <vector>

#include "sinew/pcc/arm_equations.hpp"

namespace sinew::pcc {

/// A vector of the plane, or a turn in it: `along` + i `aside`.
struct PlaneVector {
  double along = 0.0, aside = 0.0;
};

/// Workspace of one arm; nothing allocates after construction.
class PlanarEquations {
 public:
  /// Whether all segments are planar and none is turned about its axis.
  static bool apply_to(const Arm& arm);

  /// @param arm to which they apply.
  explicit PlanarEquations(std::shared_ptr<const Arm> arm);

  /// See ArmEquations::linearise(). @param q,rate,acceleration as there. @param result of the arm's
  /// size, overwritten.
  void linearise(const VectorX& q, const VectorX& rate, const VectorX& acceleration,
                 ArmEquations::Linearisation& result);

 private:
  /// A segment at its angle: theta, in the plane.
  struct Bent {
    PlaneVector turn, start, end;   ///< u; o and e from the base, m
    PlaneVector slope;              ///< u g
    PlaneVector second, third;      ///< u (g' - i g) and its derivative by theta
    double rate = 0.0, spin = 0.0;  ///< theta' and Omega
    PlaneVector alpha, alphas;      ///< and the sum of those before
    double squares = 0.0;           ///< sum of theta'^2 of those before
  };
  /// Of a particle by one angle: J, x_kk, m dx''/dtheta and m dx''/dtheta'.
  struct Column {
    PlaneVector first, second, by_position, by_rate;
  };

  void bend(const VectorX& q, const VectorX& rate, const VectorX& acceleration);
  PlaneVector accelerate(const Particle& particle, double angle);
  void add(int segment, const PlaneVector& pull, double mass,
           ArmEquations::Linearisation& result) const;

  std::shared_ptr<const Arm> arm_;
  PlaneVector gravity_;
  std::vector<PlaneVector> forces_;  // of particles, N
  std::vector<Bent> bends_;
  std::vector<Column> columns_;
};

}  // namespace sinew::pcc
