/// @file
/// Limits and inputs of a scene's arm, for the commands plan and reach.
#pragma once

#include "sinew/plan/task.hpp"

#include "arm_scene.hpp"

namespace sinew::cli {

/// The limits of the scene's arm; omitted ones are +-kNoBound.
plan::ArmLimits limits_of(const ArmScene& scene);

/// Throws Error(no-actuators) if no torque drives the arm.
void require_inputs(const ArmScene& scene);

}  // namespace sinew::cli
