/// @file
/// Limits of plans from arrays of Python.
#pragma once

#include <string>

#include "sinew/plan/task.hpp"

#include "bindings.hpp"

namespace sinew::python {

/// (n,) numbers, or one for all; empty for None. Throws Error(wrong-shape | not-finite).
/// @param value from Python. @param place names the argument. @param n how many. @param unit of
/// them, for messages.
VectorX to_optional(const py::object& value, const std::string& place, Eigen::Index n,
                    const std::string& unit);

/// Limits of torque and angle, each None, (n,) either way, or (2, n) with the lower ones first.
/// Throws as above. @param arm whose. @param torque N m. @param angle rad.
plan::ArmLimits to_limits(const pcc::Arm& arm, const py::object& torque, const py::object& angle);

}  // namespace sinew::python
