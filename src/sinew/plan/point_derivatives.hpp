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
  using Number = SecondDual<8>;
  template <typename Of>
  void evaluate(const VectorX& q, const VectorX& rate, std::size_t variables,
                const std::vector<pcc::ArmPoint>& points, const Of& of);

  pcc::ArmDynamics<Number> dynamics_;
  std::size_t n_;
  std::vector<Number> q_, rate_, still_;
  std::vector<VectorDerivatives> results_;
};

}  // namespace sinew::plan
