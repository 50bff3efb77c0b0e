/// @file
/// Forward dynamics of an arm and the exact derivatives of its equations of motion, which
/// simulation, identification and planning use.
#pragma once

#include <memory>

#include "sinew/pcc/arm_dynamics.hpp"

namespace sinew::pcc {

/// The equations of motion r = B tau of one arm, with
/// r(q, q', q'') = H q'' + C q' + K q + G + b q' - loads. Results returned by reference are valid
/// until the next call. Workspaces of derivatives are allocated at first use.
class ArmEquations {
 public:
  explicit ArmEquations(std::shared_ptr<const Arm> arm);
  ~ArmEquations();
  ArmEquations(ArmEquations&&) noexcept;
  ArmEquations& operator=(ArmEquations&&) noexcept;

  const Arm& arm() const;

  /// Forward dynamics: q'' (coordinates,) rad/s^2. Throws Error(singular-matrix) if H is not
  /// positive definite, as in a pose in which a coordinate moves no mass.
  /// @param q,rate (coordinates,). @param torque (inputs,) N m.
  const VectorX& acceleration(const VectorX& q, const VectorX& rate, const VectorX& torque);
  /// The residual r, (coordinates,) N m.
  const VectorX& residual(const VectorX& q, const VectorX& rate, const VectorX& acceleration);
  /// dr/d(masses), (coordinates, segments) N m/kg; r is linear in the masses.
  const MatrixX& mass_regressor(const VectorX& q, const VectorX& rate, const VectorX& acceleration);
  /// The mass matrix H, (coordinates, coordinates) kg m^2.
  const MatrixX& mass_matrix(const VectorX& q);
  /// The matrix C (coordinates, coordinates) from Christoffel's symbols, for which H' - 2C is skew.
  const MatrixX& coriolis_matrix(const VectorX& q, const VectorX& rate);

  /// The residual r and its derivatives.
  struct Linearisation {
    VectorX residual;                               ///< (n,)
    MatrixX by_position, by_rate, by_acceleration;  ///< (n, n) each; the last is H
  };
  const Linearisation& linearise(const VectorX& q, const VectorX& rate,
                                 const VectorX& acceleration);
  /// Second derivative of weights . r with respect to (q, q', q''), (3n, 3n). @param weights (n,).
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

  /// Positions of the segments' ends, (segments, 3) m.
  Points endpoints(const VectorX& q);
  /// Jacobian of endpoints(), (3 segments, coordinates); rows are x y z of each end in turn.
  const MatrixX& endpoint_jacobian(const VectorX& q);
  struct Energy {
    double kinetic = 0.0, strain = 0.0, gravity = 0.0;  ///< J
    double total() const { return kinetic + strain + gravity; }
  };
  Energy energy(const VectorX& q, const VectorX& rate);
  /// Position (3,) m and Jacobian (3, n) of a point, and the time derivative of the Jacobian.
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
