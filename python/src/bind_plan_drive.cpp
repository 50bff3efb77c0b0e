// Binds the inversion of planned torques to commands of drive cylinders.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/plan/drive_inversion.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "plan_drive.hpp"

namespace sinew::python {

namespace {

std::vector<plan::DriveChannel> channels_of(const std::vector<pcc::FluidicActuator>& actuators,
                                            const std::vector<pcc::DriveCylinder>& cylinders,
                                            const char* item) {
  if (actuators.size() != cylinders.size()) {
    throw Error(ErrorKind::wrong_length, {.item = item},
                fmt::format("{} actuators and {} cylinders", actuators.size(), cylinders.size()),
                "give a cylinder for each actuator");
  }
  std::vector<plan::DriveChannel> channels;
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    channels.push_back({actuators[i], cylinders[i]});
  }
  return channels;
}

std::string name(qp::QpStatus status) { return std::string(qp::qp_status_name(status)); }

}  // namespace

std::optional<plan::DriveTrain> to_drive(const py::object& actuators, const py::object& cylinders,
                                         const py::object& lead, const char* item) {
  if (actuators.is_none() && cylinders.is_none()) return {};
  const auto list = [](const py::object& given) { return given.is_none() ? py::list() : given; };
  plan::DriveTrain drive;
  drive.channels = channels_of(list(actuators).cast<std::vector<pcc::FluidicActuator>>(),
                               list(cylinders).cast<std::vector<pcc::DriveCylinder>>(), item);
  if (!lead.is_none()) {
    drive.lead = to_number(lead, item, "s");
    if (!(drive.lead >= 0.0)) {
      throw Error(ErrorKind::out_of_range, {.item = item},
                  fmt::format("the lead is {:g} s", drive.lead), "give zero or more");
    }
  }
  return drive;
}

py::dict drive_result(const plan::DriveRun& run) {
  py::dict result;
  result["times"] = copy(run.times);
  result["command"] = copy(run.command);
  result["volume"] = copy(run.volume);
  result["lead"] = run.lead;
  return result;
}

void bind_plan_drive(py::module_& module) {
  module.def(
      "plan_invert_cylinder",
      [](const pcc::DriveCylinder& cylinder, const py::object& volume, const py::object& start,
         double smoothing) {
        const auto list = to_list(volume, "invert_cylinder(volume)", "m^3");
        const auto found = plan::invert_cylinder(
            cylinder,
            Eigen::Map<const VectorX>(list.data(), static_cast<Eigen::Index>(list.size())),
            {to_vector(start, "invert_cylinder(start)", 2, ""), smoothing});
        py::dict result;
        result["status"] = name(found.status);
        result["command"] = copy(found.command);
        result["volume"] = copy(found.volume);
        return result;
      },
      py::arg("cylinder"), py::arg("volume"), py::kw_only(),
      py::arg("start") = py::make_tuple(0.0, 0.0),
      py::arg("smoothing") = plan::CylinderInversionSettings{}.smoothing,
      R"(plan_invert_cylinder(cylinder, volume, *, start=(0.0, 0.0), smoothing=1e-06)
--

Finds the commands with which a cylinder delivers volumes as closely as its dynamics and limits allow: minimises
``sum (volume - C x - D u)**2`` by a quadratic program.

Parameters
----------
cylinder : sinew.pcc.DriveCylinder
volume : (samples,) m^3
    At its sample times.
start : (2,)
    Its state at the first of them.
smoothing : float
    Cost of changes of the command relative to errors of the volume, positive.

Returns
-------
dict
    "status" ('optimal', or 'infeasible' if no command keeps the volume within its limits),
    "command" (samples,), "volume" (samples,) m^3, delivered under the command.

Raises
------
Error
    out-of-range, not-finite, too-few-points, contradictory-limits.)");
  module.def(
      "plan_invert_drive",
      [](const plan::Plan& of, const std::vector<pcc::FluidicActuator>& actuators,
         const std::vector<pcc::DriveCylinder>& cylinders, double lead, double smoothing) {
        const auto channels = channels_of(actuators, cylinders, "invert_drive");
        const auto found = plan::invert_drive(of, channels, lead, {.smoothing = smoothing});
        py::list status;
        for (const qp::QpStatus one : found.status) status.append(name(one));
        py::dict result;
        result["found"] = found.found;
        result["status"] = status;
        result["times"] = copy(found.times);
        result["command"] = copy(found.command);
        result["wanted"] = copy(found.wanted);
        result["volume"] = copy(found.volume);
        return result;
      },
      py::arg("plan"), py::arg("actuators"), py::arg("cylinders"), py::kw_only(), py::arg("lead"),
      py::arg("smoothing") = plan::CylinderInversionSettings{}.smoothing,
      R"(plan_invert_drive(plan, actuators, cylinders, *, lead, smoothing=1e-06)
--

Finds the commands of the cylinders for a plan: the inverse of the actuators gives the volumes, advanced by
the delay; invert_cylinder() then gives the commands of each cylinder.

Parameters
----------
plan : Plan
actuators, cylinders : list of FluidicActuator, list of DriveCylinder
    One each for each input of the arm; all cylinders have one sample time.
lead : float
    Time from the first command to the start of the plan's torque, s, at least the longest delay: cylinders may move in it.

Returns
-------
dict
    "found", "status" of each cylinder, "times" (samples,) s from 0 to lead + duration, and
    (samples, inputs) "command", "wanted" (m^3, from the inverse of the actuators) and "volume" (m^3,
    delivered under the commands).

Raises
------
Error
    wrong-length, out-of-range and the errors of invert_cylinder().)");
}

}  // namespace sinew::python
