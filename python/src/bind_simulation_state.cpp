// Copies, states and files of states of a simulation.
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

void bind_copies(SimulationType& type) {
  type.def("reset", &Session::reset,
           R"(reset($self)
--

Back to the start, bit for bit: state, time, and the scene's commands; external forces become zero,
and a base that move_base() moved is back.
Controllers stay attached and keep their targets.
)")
      .def("clone", &Session::clone,
           R"(clone($self)
--

A further simulation of the same robot, at the same state, with the same commands and controller.

It shares the model (mesh, symbolic factorisation) and costs `memory` bytes. The two may run side
by side in threads.

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
                "a sinew.Simulation does not pickle; send sim.to_yaml() and sim.state(), load the "
                "text elsewhere with sinew.loads(text), and restore(state) there");
          },
          "Raises TypeError, which says what to pickle instead.");
}

void bind_state_values(SimulationType& type) {
  type.def("state", &Session::state,
           R"(state($self)
--

Everything that decides, together with the inputs, how the run goes on.

Returns
-------
sinew.State
    A value: it compares, copies and pickles, and stays what it is while the simulation goes on.
)")
      .def("restore", &Session::restore, py::arg("state"),
           R"(restore($self, state)
--

Takes up a state; the run then goes on bit for bit as the one that it came from.

An attached controller takes up its memory where the state has it, and begins anew otherwise.
Commands, factors of loads, external forces and tethers stay as they are.

Parameters
----------
state : sinew.State
    Of this simulation, a clone, or another one of the same robot.

Raises
------
Error
    state-mismatch for a state of another robot, naming what differs; the state is then as before.
)");
}

void bind_state_files(SimulationType& type) {
  type.def("save_state", &Session::save_state, py::arg("path"),
           R"(save_state($self, path)
--

Writes the state: positions, velocities, bases, efforts, drives, time. Commands and external forces
are inputs and are not part of it.

Parameters
----------
path : path-like
    The file appears whole or not at all.

Raises
------
Error
    file-unwritable.
)")
      .def("load_state", &Session::load_state, py::arg("path"),
           R"(load_state($self, path)
--

Puts back what save_state() wrote for the same robot; commands stay as they are.

Parameters
----------
path : path-like

Raises
------
Error
    file-not-found, state-corrupt, state-version, or state-mismatch for a file of another robot;
    the state is then as before.
)");
}

}  // namespace

void bind_simulation_state(SimulationType& type) {
  bind_copies(type);
  bind_state_values(type);
  bind_state_files(type);
}

}  // namespace sinew::python
