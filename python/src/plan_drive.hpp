// Converts drives of plans between Python and C++.
#pragma once

#include <optional>

#include "sinew/plan/drive_run.hpp"
#include "sinew/plan/task.hpp"

#include "arrays.hpp"

namespace sinew::python {

/// Makes a drive; none if neither actuators nor cylinders are given. Throws Error(wrong-length |
/// out-of-range).
/// @param actuators,cylinders lists from Python, or None. @param lead s; None: the longest delay.
/// @param item named in errors.
std::optional<plan::DriveTrain> to_drive(const py::object& actuators, const py::object& cylinders,
                                         const py::object& lead, const char* item);
/// A dict with the keys "times", "command", "volume", "lead".
py::dict drive_result(const plan::DriveRun& run);

}  // namespace sinew::python
