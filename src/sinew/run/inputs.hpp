/// @file
/// External inputs of a run, which stay in effect until they are changed.
#pragma once

#include <optional>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/signal.hpp"

namespace sinew::run {

/// Inputs of one body; members that the body does not support are empty.
struct BodyInputs {
  Points external_forces;                   ///< (n, 3) N on all mesh nodes
  std::optional<mechanics::Tether> tether;  ///< spring from a point to an anchor in the world
  std::optional<mechanics::AffineField>
      base;                       ///< where fixed nodes go in the next step; none: they stay
  double stiffness_factor = 1.0;  ///< > 0, see mechanics::ScalesStiffness
};

/// The inputs of a simulation as a value, see Simulation::inputs().
struct Inputs {
  std::vector<model::Command> commands;  ///< (actuators,)
  std::vector<model::Signal> loads;      ///< (loads,) factors
  std::vector<BodyInputs> bodies;
  bool follows = false;  ///< see Simulation::follow()
};

}  // namespace sinew::run
