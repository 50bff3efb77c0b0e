// Clones, states and state files of a simulation.
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

void bind_copies(SimulationType& type) {
  type.def("reset", &Session::reset,
           R"(reset($self)
--

Restores the start, bit for bit: state, time, and the scene's commands. External forces become zero,
and a base moved by move_base() returns.
Controllers stay attached and keep their targets.
)")
      .def("clone", &Session::clone,
           R"(clone($self)
--

Creates another simulation of the same robot, with the same state, commands and controller.

It shares the model (mesh, symbolic factorisation) and costs `memory` bytes. Both may run in
parallel threads.

Returns
-------
Simulation
)")
      .def("__copy__", &Session::clone, "A clone().")
      .def(
          "__deepcopy__", [](const Session& self, const py::dict&) { return self.clone(); },
          "A clone(), which shares the model.")
      .def(
          "__reduce_ex__",
          [](const Session&, const py::object&) -> py::object {
            throw py::type_error(
                "a sinew.Simulation cannot be pickled; send sim.to_yaml() and sim.state(), load "
                "the text "
                "elsewhere with sinew.loads(text), and restore(state) there");
          },
          "Raises TypeError, which names what to pickle instead.");
}

void bind_state_values(SimulationType& type) {
  type.def("state", &Session::state,
           R"(state($self)
--

The state of the run. State and inputs together determine how the run continues.

Returns
-------
sinew.State
    A value that can be compared, copied and pickled. It does not change while the simulation continues.
)")
      .def("restore", &Session::restore, py::arg("state"),
           R"(restore($self, state)
--

Restores a state. The run then continues bit for bit like the run that the state comes from.

An attached controller restores its memory if the state contains it, and starts anew otherwise.
Commands, load factors, external forces and tethers are not changed.

Parameters
----------
state : sinew.State
    Of this simulation, a clone, or another one of the same robot.

Raises
------
Error
    state-mismatch for a state of another robot, naming the difference; the state is then unchanged.
)");
}

void bind_state_files(SimulationType& type) {
  type.def("save_state", &Session::save_state, py::arg("path"),
           R"(save_state($self, path)
--

Writes the state: positions, velocities, bases, efforts, drives, time. Commands and external forces
are inputs and not part of it.

Parameters
----------
path : path-like
    The file is written completely or not at all.

Raises
------
Error
    file-unwritable.
)")
      .def("load_state", &Session::load_state, py::arg("path"),
           R"(load_state($self, path)
--

Restores a state written by save_state() for the same robot. Commands are not changed.

Parameters
----------
path : path-like

Raises
------
Error
    file-not-found, state-corrupt, state-version, or state-mismatch for a file of another robot;
    the state is then unchanged.
)");
}

}  // namespace

void bind_simulation_state(SimulationType& type) {
  bind_copies(type);
  bind_state_values(type);
  bind_state_files(type);
}

}  // namespace sinew::python
