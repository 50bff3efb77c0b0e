/// @file
/// Functions that bind the parts of the module; module.cpp calls them in order. Docstrings start
/// with "name($self, ...)\n--\n\n", from which Python's inspect and help() take the signature.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace sinew::control {
class Target;
}  // namespace sinew::control

namespace sinew::model {
class Signal;
}

namespace sinew::python {

namespace py = pybind11;

class Session;
struct AttachedController;

void bind_signals(py::module_& module);
void bind_targets(py::module_& module);
void bind_reports(py::module_& module);
void bind_linear_model(py::module_& module);
void bind_parameters(py::module_& module);
void bind_actuator(py::module_& module);
void bind_effector(py::module_& module);
void bind_load(py::module_& module);
void bind_mass(py::module_& module);
void bind_probe(py::module_& module);
void bind_sensor(py::module_& module);
void bind_estimator(py::module_& module);
void bind_contact(py::module_& module);
void bind_joint(py::module_& module);
void bind_body(py::module_& module);
void bind_state(py::module_& module);
void bind_simulation(py::module_& module);
void bind_batch(py::module_& module);
void bind_controller(py::module_& module);
void bind_mesh(py::module_& module);
void bind_view(py::module_& module);
void bind_material(py::module_& module);
void bind_pcc(py::module_& module);
void bind_bending(py::module_& module);
void bind_bending_fit(py::module_& module);
void bind_plan(py::module_& module);
void bind_plan_reach(py::module_& module);
void bind_brace(py::module_& module);
void bind_plan_drive(py::module_& module);
void bind_drive(py::module_& module);
void bind_qp(py::module_& module);
void bind_quadratic(py::module_& module);
void bind_response(py::module_& module);
void bind_quantity(py::module_& module);
void bind_collision(py::module_& module);
void bind_collision_pairs(py::module_& module);
void bind_collision_primitives(py::module_& module);
void bind_high_rate(py::module_& module);
void bind_identify(py::module_& module);
void bind_identify_arm(py::module_& module);
void bind_identify_material(py::module_& module);

/// A part of a simulation, which it keeps alive.
struct Part {
  std::shared_ptr<Session> session;
  int index = 0;
};
struct Actuator : Part {};
struct Effector : Part {};
struct Load : Part {};
struct PointMass : Part {};
struct Probe : Part {};
struct Sensor : Part {};
struct Estimator : Part {};
struct Contact : Part {};
struct Joint : Part {};
struct Body : Part {};

/// Binds stress and strain of bodies. @param module,type to which they are added.
void bind_fields(py::module_& module, py::class_<Body>& type);

/// A controller and the simulation that it steers, which it keeps alive.
struct Controller {
  std::shared_ptr<Session> session;
  std::shared_ptr<AttachedController> attached;
};

/// Runs and records a simulation; see Simulation.run in bind_simulation_stepping.cpp.
py::dict run(const std::shared_ptr<Session>& session, const py::object& duration,
             const py::object& record, const py::object& every, const py::object& progress,
             bool keep_going);

/// Converts a Target object or three numbers to a target. Throws Error(wrong-type | wrong-shape |
/// not-finite).
/// @param value from Python. @param place names the argument.
control::Target to_target(const py::handle& value, const std::string& place);

/// Converts a Signal object, a number, or (n, 2) samples of time and value to a signal.
/// @param value from Python. @param place names the argument. @param unit "N" or "m".
model::Signal to_signal(const py::handle& value, const std::string& place, const std::string& unit);

}  // namespace sinew::python
