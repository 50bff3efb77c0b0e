/// @file
/// Response of effectors and actuators to changes of some actuators' efforts, while all other parts
/// of the robot follow their laws: the Jacobian of a controller.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/linearisation.hpp"

namespace sinew::sim {

class Simulation;

/// d delta = W d lambda_a for the efforts lambda_a of the controlled actuators, at one state: the
/// condensed compliance of law::Response. Other actuators keep their commands (an effort is
/// constant, a motion is held, a drive follows its curve), contact points and cables at their
/// guides continue to stick or slide, and joints hold.
struct ControlledResponse {
  std::vector<MatrixX> effectors;  ///< W_ea of each (rows, controlled), m/N, m/Pa, rad/N ...
  MatrixX actuators;               ///< W_aa (controlled, controlled), m/N, m^3/Pa, rad/(N m) ...
};

/// The response at the present state, which is restored bit for bit. Throws Error(singular-matrix).
/// @param simulation in any state.
/// @param controlled indices of Model::actuators(), without duplicates; their order is that of the
///   result. @param choice tangent and terms of the linearisation.
ControlledResponse controlled_response(Simulation& simulation, std::span<const int> controlled,
                                       const LinearisationChoice& choice = {});

}  // namespace sinew::sim
