/// @file
/// The equations of motion of an arm whose segments all bend in one plane, with first derivatives
/// in closed form. ArmEquations::linearise() uses them for such arms.

// Vectors of the plane are complex numbers: the real part is along the base's axis, the imaginary
// part along its x. Segment n starts rotated by u_n = e^(i phi_n), phi_n = sum_(k<n) theta_k. Its
// point at the fraction f of the arc is
//   x = o_n + u_n f L_n E(f theta_n),   E(a) = (e^(ia) - 1)/(ia),
// where o_n is the start and e_n the end of its bend. With J_k = dx/dtheta_k and g = L E',
//   J_k = i (x - e_k) + u_k g_k                      for k < n,   J_n = u_n f^2 L_n E',
//   d2x/dtheta_k dtheta_j = i J_max(k,j)              for k != j,
//   d2x/dtheta_k^2 = i J_k + u_k (g'_k - i g_k)       for k < n,
// since theta_k rotates everything beyond e_k. Likewise, with Omega_k = sum_(j<k) theta'_j and
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

/// A vector of the plane, or a rotation in it: `along` + i `aside`.
struct PlaneVector {
  double along = 0.0, aside = 0.0;
};

/// The equations of one planar arm, with their workspace. Nothing allocates after construction.
class PlanarEquations {
 public:
  /// Whether the equations apply to an arm: all segments are planar, and none is rotated about its
  /// axis.
  static bool apply_to(const Arm& arm);

  /// @param arm for which apply_to() is true.
  explicit PlanarEquations(std::shared_ptr<const Arm> arm);

  /// Computes the residual and its derivatives, as ArmEquations::linearise().
  /// @param q,rate,acceleration (n,) each. @param result of size n, overwritten.
  void linearise(const VectorX& q, const VectorX& rate, const VectorX& acceleration,
                 ArmEquations::Linearisation& result);

 private:
  /// A bent segment.
  struct Bent {
    PlaneVector turn, start, end;   ///< u; o and e relative to the base, m
    PlaneVector slope;              ///< u g
    PlaneVector second, third;      ///< u (g' - i g), and its derivative with respect to theta
    double rate = 0.0, spin = 0.0;  ///< theta' and Omega
    PlaneVector alpha, alphas;      ///< alpha, and its sum over the segments before
    double squares = 0.0;           ///< sum of theta'^2 over the segments before
  };
  /// Derivatives of a particle with respect to one angle: J, x_kk, m dx''/dtheta, m dx''/dtheta'.
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
