// Tasks shared by tests.
#pragma once

#include <numbers>

#include "sinew/plan/planner.hpp"

#include "arms.hpp"

namespace sinew::plan::testing {

using pcc::testing::make;

inline const Vector3 kGoals[] = {
    {-0.25, 0.0, -0.45}, {0.15, 0.0, -0.35}, {0.20, 0.0, -0.40}, {-0.30, 0.0, -0.30}};

/// The published grab: torques are limited, and the first segment has none.
inline PlanTask grab(const Vector3& goal = kGoals[0]) {
  PlanTask task;
  task.goal.position = goal;
  task.limits.torque_upper = pcc::published_torque_limits();
  task.limits.torque_lower = -task.limits.torque_upper;
  return task;
}

}  // namespace sinew::plan::testing
