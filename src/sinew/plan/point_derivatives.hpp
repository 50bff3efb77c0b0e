/// @file
/// Positions and velocities of points of an arm, with exact first and second derivatives.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "sinew/pcc/arm_dynamics.hpp"

namespace sinew::plan {

/// Value and derivatives of a spatial vector as a function of variables.
struct VectorDerivatives {
  Vector3 value;
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian;  ///< (3, variables)
  std::array<MatrixX, 3> hessian;                     ///< of x, y, z: (variables, variables)
};

/// Computes the derivatives for one arm. Results are references to its workspace, valid until the
/// next call.
class PointDerivatives {
 public:
  explicit PointDerivatives(std::shared_ptr<const pcc::Arm> arm);

  /// Positions (m) of points, as functions of q. @param q (coordinates,). @param points of the arm.
  const std::vector<VectorDerivatives>& positions(const VectorX& q,
                                                  const std::vector<pcc::ArmPoint>& points);
  /// Velocity (m/s) of a point, as a function of (q, q'). @param q,rate (coordinates,).
  /// @param point of the arm.
  const VectorDerivatives& velocity(const VectorX& q, const VectorX& rate,
                                    const pcc::ArmPoint& point);

 private:
  using First = Dual<8>;
  using Moving = pcc::Varied<First>;
  /// Differentiates in passes over the variables, q first, then q'. Calls `take` with the first
  /// variable of each pass.
  template <typename Take>
  void pass(const VectorX& q, const VectorX& rate, Eigen::Index variables, const Take& take);

  pcc::ArmDynamics<Moving> dynamics_;
  std::size_t n_;
  std::vector<Moving> q_;
  std::vector<pcc::Vec3<Moving>> columns_;
  std::vector<VectorDerivatives> positions_;
  VectorDerivatives velocity_;
};

}  // namespace sinew::plan
