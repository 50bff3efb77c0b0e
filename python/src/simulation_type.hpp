/// @file
/// sinew.Simulation, whose parts are bound in files of their own.
#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

using SimulationType = py::class_<Session, std::shared_ptr<Session>>;

/// Its actuators, effectors, bodies and so on, by their names.
void bind_simulation_parts(SimulationType& type);
/// Copies, states and files of states.
void bind_simulation_state(SimulationType& type);
/// What it tells of itself.
void bind_simulation_reports(SimulationType& type);
/// Whatever moves it.
void bind_simulation_stepping(SimulationType& type);
/// How motions follow from efforts.
void bind_simulation_linearisation(SimulationType& type);
/// How effectors follow from the efforts of controlled actuators.
void bind_simulation_response(SimulationType& type);
/// Problems of contacts by themselves: their files, and Simulation.contact_problem().
/// @param module,type where they go.
void bind_contact_problem(py::module_& module, SimulationType& type);

}  // namespace sinew::python
