/// @file
/// The blocks of a step's problem that stay for all steps of a model.
#pragma once

#include "sinew/step/step_problem.hpp"

namespace sinew::sim {

class Model;

/// A problem with the model's cable friction and held rows, and room for its actuators: all blocks
/// but those of contacts and stiffness, which come and go.
/// @param model of them. @param joint_actuators actuators of joints, behind the model's own.
step::StepProblem standing_blocks(const Model& model, std::size_t joint_actuators);

}  // namespace sinew::sim
