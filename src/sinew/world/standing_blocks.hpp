/// @file
/// The permanent blocks of a step's problem.
#pragma once

#include "sinew/law/step_problem.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::world {

/// A problem with all permanent blocks of a model: cable friction, joints, and room for its
/// actuators. Blocks of contacts and anchors or couplings are added elsewhere.
/// @param model with these parts.
/// @param joint_actuators number of blocks for limits and friction of joints, after those of the
///   actuators.
law::StepProblem standing_blocks(const model::Model& model, std::size_t joint_actuators);

}  // namespace sinew::world
