/// @file
/// The functions that bind sinew.Simulation, each in a file of its own.
#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

using SimulationType = py::class_<Session, std::shared_ptr<Session>>;

/// Binds access to actuators, effectors, bodies and so on, by their names.
void bind_simulation_parts(SimulationType& type);
/// Binds copies, states and state files.
void bind_simulation_state(SimulationType& type);
/// Binds reports and observables.
void bind_simulation_reports(SimulationType& type);
/// Binds steps and solvers.
void bind_simulation_stepping(SimulationType& type);
/// Binds the linearised response of motions to efforts.
void bind_simulation_linearisation(SimulationType& type);
void bind_simulation_linear_model(SimulationType& type);
void bind_simulation_parameters(SimulationType& type);
/// Binds the response of effectors to the efforts of controlled actuators.
void bind_simulation_response(SimulationType& type);
/// Binds contact problems: their files, and Simulation.contact_problem().
/// @param module,type to which they are added.
void bind_contact_problem(py::module_& module, SimulationType& type);

}  // namespace sinew::python
