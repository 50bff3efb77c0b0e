/// @file
/// What planning and reach share of a scene's arm.
#pragma once

#include "sinew/plan/task.hpp"

#include "arm_scene.hpp"

namespace sinew::cli {

/// The scene's limits, those left out as none.
plan::ArmLimits limits_of(const ArmScene& scene);

/// Throws Error(no-actuators) where no torque drives the arm.
void require_inputs(const ArmScene& scene);

}  // namespace sinew::cli
