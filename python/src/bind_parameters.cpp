// Binds the named numbers on which the motion of a robot depends.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "sinew/sim/parameters.hpp"

#include "simulation_type.hpp"

namespace sinew::python {

void bind_parameters(py::module_& module) {
  py::class_<Parameter>(module, "Parameter",
                        "A physical number on which motion depends. From Simulation.parameters().")
      .def_readonly("path", &Parameter::path,
                    "str: 'bodies.finger.parts.tip.material.young_modulus'. Where a scene states "
                    "the number itself, it is its path there.")
      .def_readonly("unit", &Parameter::unit, "str: SI unit; empty for a number without one.")
      .def_readonly("value", &Parameter::value, "float: the value, in that unit.")
      .def("__repr__", [](const Parameter& self) {
        return fmt::format("<sinew.Parameter {} = {:g}{}{}>", self.path, self.value,
                           self.unit.empty() ? "" : " ", self.unit);
      });
}

void bind_simulation_parameters(SimulationType& type) {
  type.def(
          "parameters",
          [](Session& self) {
            const Session::Use use(self);
            py::dict all;
            for (const Parameter& one : sim::parameters(self.simulation())) {
              all[py::str(one.path)] = one;
            }
            return all;
          },
          R"(parameters($self)
--

The numbers on which the motion of the robot depends, by their paths: of materials, masses, damping,
actuators and their limits, loads, contacts and joints, in SI units.

    sim.parameters()["bodies.trunk.material.young_modulus"].value

Where the scene states the number itself, the path is that of the scene, so that it serves `set=` of
sinew.load(), sweeps and fits as well. The last ones are inputs, which set_parameter() sets: constant
commands, constant load factors, and `bodies.NAME.stiffness_factor`.

Returns
-------
dict of str to Parameter
    With `path`, `unit` and `value`, in the order of the model. Components of vectors are apart:
    'bodies.trunk.gravity.z'.
)")
      .def(
          "set_parameter",
          [](Session& self, const std::string& path, double value) {
            const Session::Use use(self);
            sim::set_parameter(self.simulation(), path, value);
          },
          py::arg("path"), py::arg("value"),
          R"(set_parameter($self, path, value)
--

Set an input among parameters(), from the next step on.

Parameters
----------
path : str
    'actuators.NAME.command.QUANTITY', 'loads.NAME.factor' or 'bodies.NAME.stiffness_factor'.
value : float
    In the unit of the parameter.

Raises
------
sinew.Error
    `unknown-name`; `bad-argument` for a parameter of the model: load the scene with another value
    instead; `actuator-owned` while a controller owns the actuator; `out-of-range`.
)");
}

}  // namespace sinew::python
