/// @file
/// How effectors and actuators move when the efforts of some actuators change and everything else
/// on the robot obeys its law: the Jacobian of a controller.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/linearisation.hpp"

namespace sinew::sim {

class Simulation;

/// d delta = W d lambda_a over the efforts lambda_a of the controlled actuators, at one state: the
/// condensed compliance of step::Response. Other actuators keep their commands (an effort stays, a
/// motion is held, a drive follows its curve), contact points and cables at their guides keep
/// sticking or sliding, joints hold.
struct ControlledResponse {
  std::vector<MatrixX> effectors;  ///< W_ea of each (its rows, controlled), m/N, m/Pa or rad/N ...
  MatrixX actuators;               ///< W_aa (controlled, controlled), m/N, m^3/Pa, rad/(N m) ...
};

/// Of the present state, which stays as it is bit for bit. Throws Error(singular-matrix).
/// @param simulation in any state. @param controlled indices of Model::actuators(), each once, in
/// any order, which is that of the result. @param choice see there.
ControlledResponse controlled_response(Simulation& simulation, std::span<const int> controlled,
                                       const LinearisationChoice& choice = {});

}  // namespace sinew::sim
