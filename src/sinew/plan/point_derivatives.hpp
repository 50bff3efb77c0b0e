/// @file
/// Where points of an arm are and how they move, with exact first and second derivatives.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "sinew/pcc/arm_dynamics.hpp"

namespace sinew::plan {

/// A vector of space as a function of variables.
struct VectorDerivatives {
  Vector3 value;
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian;  ///< (3, variables)
  std::array<MatrixX, 3> hessian;                     ///< of x, y, z: (variables, variables)
};

/// Workspace of one arm.
class PointDerivatives {
 public:
  explicit PointDerivatives(std::shared_ptr<const pcc::Arm> arm);

  /// Positions (m) of points, by q. @param q (coordinates,). @param points which.
  const std::vector<VectorDerivatives>& positions(const VectorX& q,
                                                  const std::vector<pcc::ArmPoint>& points);
  /// Velocity (m/s) of a point, by (q, q'). @param q,rate (coordinates,). @param point which.
  const VectorDerivatives& velocity(const VectorX& q, const VectorX& rate,
                                    const pcc::ArmPoint& point);

 private:
  using First = Dual<8>;
  using Moving = pcc::Varied<First>;
  /// In passes of some variables, q first, then q': `take` is called with the first of each.
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
