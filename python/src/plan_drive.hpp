// Drives of plans between Python and C++.
#pragma once

#include <optional>

#include "sinew/plan/drive_run.hpp"
#include "sinew/plan/task.hpp"

#include "arrays.hpp"

namespace sinew::python {

/// None where neither actuators nor cylinders are given. Throws Error(wrong-length | out-of-range).
/// @param actuators,cylinders lists from Python, or None. @param lead s, or None: the longest
/// delay.
/// @param item what an error names.
std::optional<plan::DriveTrain> to_drive(const py::object& actuators, const py::object& cylinders,
                                         const py::object& lead, const char* item);
/// "times", "command", "volume", "lead".
py::dict drive_result(const plan::DriveRun& run);

}  // namespace sinew::python
