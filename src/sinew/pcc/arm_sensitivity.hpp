/// @file
/// Derivatives of an arm's motion with respect to parameters, by exact differentiation of every
/// implicit step (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, 1993, II.6).
#pragma once

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/pcc/arm_simulation.hpp"

namespace sinew::pcc {

/// Forward sensitivities of ArmSimulation. A step solves g(d) = r(q + d, q', q'') - B tau = 0 for
/// the motion d, where the integrator makes velocity q' and acceleration q'' by linear combination
/// of d, the rate and its history. Hence
///   dg/dd . dd/dp = -(dr/dp - B dtau/dp) - dr/dq . dq/dp - dr/dq' . (..) - H (..),
/// where the brackets are the same combinations of derivatives. Nothing allocates after
/// construction.
class ArmSensitivity {
 public:
  /// @param coordinates number of coordinates of the arm. @param parameters number of parameters.
  ArmSensitivity(Eigen::Index coordinates, Eigen::Index parameters);

  /// Sets the sensitivities of the initial state. @param position,rate (coordinates, parameters).
  void start(const MatrixX& position, const MatrixX& rate);
  /// Advances the sensitivities over the last step of the simulation.
  /// @param simulation since whose last step nothing was linearised with its equations.
  /// @param by_parameter dr/dp - B dtau/dp at the end of the step, (coordinates, parameters), N m.
  void follow(const ArmSimulation& simulation, const MatrixX& by_parameter);

  const MatrixX& position() const { return position_; }  ///< dq/dp, (coordinates, parameters)
  const MatrixX& rate() const { return rate_; }          ///< dq'/dp

 private:
  MatrixX position_, rate_, first_, second_;
  MatrixX motion_, velocity_, acceleration_, right_;
  linalg::LuFactor decomposed_;
};

}  // namespace sinew::pcc
