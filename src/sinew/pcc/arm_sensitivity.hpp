/// @file
/// Derivatives of an arm's motion by parameters: every implicit step differentiated, exactly
/// (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, II.6).
#pragma once

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/pcc/arm_simulation.hpp"

namespace sinew::pcc {

/// A step solves g(d) = r(q + d, q', q'') - B tau = 0 for the motion d, with velocity q' and
/// acceleration q'' the integrator's combinations of d and of what the last step left. So
///   dg/dd . dd/dp = -(dr/dp - B dtau/dp) - dr/dq . dq/dp - dr/dq' . (..) - H (..),
/// the brackets the same combinations of derivatives. Nothing allocates after construction.
class ArmSensitivity {
 public:
  /// @param coordinates of the arm. @param parameters how many.
  ArmSensitivity(Eigen::Index coordinates, Eigen::Index parameters);

  /// Of the start. @param position,rate (coordinates, parameters).
  void start(const MatrixX& position, const MatrixX& rate);
  /// Goes along with the step that the simulation has just made.
  /// @param simulation whose equations were not used since, other than at points and for masses.
  /// @param by_parameter dr/dp - B dtau/dp at the step's end, (coordinates, parameters), N m.
  void follow(const ArmSimulation& simulation, const MatrixX& by_parameter);

  const MatrixX& position() const { return position_; }  ///< dq/dp, (coordinates, parameters)
  const MatrixX& rate() const { return rate_; }          ///< dq'/dp

 private:
  MatrixX position_, rate_, first_, second_;
  MatrixX motion_, velocity_, acceleration_, right_;
  linalg::LuFactor decomposed_;
};

}  // namespace sinew::pcc
