/// @file
/// The permanent blocks of a step's problem.
#pragma once

#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

class Model;

/// A problem with all permanent blocks of a model: cable friction, joints, and room for its
/// actuators. Blocks of contacts and anchors or couplings are added elsewhere.
/// @param model with these parts.
/// @param joint_actuators number of blocks for limits and friction of joints, after those of the
///   actuators.
step::StepProblem standing_blocks(const Model& model, std::size_t joint_actuators);

}  // namespace sinew::sim
