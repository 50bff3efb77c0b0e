/// @file
/// Forward dynamics of an arm and the exact derivatives of its equations of motion, which
/// simulation, identification and planning use.
#pragma once

#include <memory>

#include "sinew/pcc/arm_dynamics.hpp"

namespace sinew::pcc {

/// Workspace of one arm; nothing allocates after construction. With
/// r(q, q', q'') = H q'' + C q' + G + b q' - loads, motion obeys r = B tau.
class ArmEquations {
 public:
  explicit ArmEquations(std::shared_ptr<const Arm> arm);
  ~ArmEquations();
  ArmEquations(ArmEquations&&) noexcept;
  ArmEquations& operator=(ArmEquations&&) noexcept;

  const Arm& arm() const;

  /// q'' (coordinates,) rad/s^2. @param q,rate (coordinates,). @param torque (inputs,) N m.
  /// Throws Error(singular-matrix) where H is not positive definite: a segment without mass beyond
  /// it, or a pose in which a mass cannot be moved.
  const VectorX& acceleration(const VectorX& q, const VectorX& rate, const VectorX& torque);
  /// r (coordinates,) N m.
  const VectorX& residual(const VectorX& q, const VectorX& rate, const VectorX& acceleration);
  /// dr/d(masses), (coordinates, segments) N m/kg: r is linear in them.
  const MatrixX& mass_regressor(const VectorX& q, const VectorX& rate, const VectorX& acceleration);
  /// H (coordinates, coordinates), kg m^2.
  const MatrixX& mass_matrix(const VectorX& q);
  /// C (coordinates, coordinates) of Christoffel's symbols, so that H' - 2C is skew.
  const MatrixX& coriolis_matrix(const VectorX& q, const VectorX& rate);

  /// r and its derivatives.
  struct Linearisation {
    VectorX residual;                               ///< (n,)
    MatrixX by_position, by_rate, by_acceleration;  ///< (n, n) each; the last is H
  };
  const Linearisation& linearise(const VectorX& q, const VectorX& rate,
                                 const VectorX& acceleration);
  /// Second derivative of weights . r by (q, q', q''), (3n, 3n). @param weights (n,).
  /// @param q,rate,acceleration (n,) each.
  const MatrixX& curvature(const VectorX& weights, const VectorX& q, const VectorX& rate,
                           const VectorX& acceleration);

  /// Forward dynamics with its derivatives, from q'' = H^-1 (B tau - bias):
  /// dq''/d(q, q') = -H^-1 dr/d(q, q') at that q''.
  struct ForwardDerivatives {
    VectorX acceleration;                     ///< (n,)
    MatrixX by_position, by_rate, by_torque;  ///< (n, n), (n, n), (n, inputs)
  };
  const ForwardDerivatives& forward_derivatives(const VectorX& q, const VectorX& rate,
                                                const VectorX& torque);

  /// Positions (segments, 3) m of the segments' ends.
  Points endpoints(const VectorX& q);
  /// Of these by q: (3 segments, coordinates), x y z of one end after the other.
  const MatrixX& endpoint_jacobian(const VectorX& q);
  struct Energy {
    double kinetic = 0.0, strain = 0.0, gravity = 0.0;  ///< J
    double total() const { return kinetic + strain + gravity; }
  };
  Energy energy(const VectorX& q, const VectorX& rate);
  /// A point's position (3,) m, Jacobian (3, n), and d/dt of the Jacobian along the rate.
  struct PointMotion {
    Vector3 position;
    Matrix3 rotation;  ///< of the section
    MatrixX jacobian, jacobian_rate;
  };
  PointMotion point(const ArmPoint& point, const VectorX& q, const VectorX& rate);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace sinew::pcc
