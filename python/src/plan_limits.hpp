/// @file
/// Limits of planning as Python gives them.
#pragma once

#include "sinew/plan/task.hpp"

#include "arrays.hpp"

namespace sinew::python {

/// On torque and angle. @param arm whose. @param torque (inputs,) either way or (2, inputs) N m.
/// @param angle the same by coordinates, rad, or None. Throws Error(wrong-shape).
plan::Limits reach_limits(const pcc::Arm& arm, const py::object& torque, const py::object& angle);

/// Defines bracing in a module.
void bind_brace(py::module_& module);

}  // namespace sinew::python
