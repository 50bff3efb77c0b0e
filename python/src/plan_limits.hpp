/// @file
/// Converts limits of plans from Python arrays.
#pragma once

#include <string>

#include "sinew/plan/task.hpp"

#include "bindings.hpp"

namespace sinew::python {

/// Converts (n,) numbers, or one number for all; None becomes an empty vector. Throws
/// Error(wrong-shape | not-finite).
/// @param value from Python. @param place names the argument. @param n size. @param unit for
/// messages.
VectorX to_optional(const py::object& value, const std::string& place, Eigen::Index n,
                    const std::string& unit);

/// Converts limits of torque and angle. Each is None, (n,) absolute limits, or (2, n) with the
/// lower ones first. Throws what to_optional() throws. @param arm of the limits. @param torque N m.
/// @param angle rad.
plan::ArmLimits to_limits(const pcc::Arm& arm, const py::object& torque, const py::object& angle);

}  // namespace sinew::python
