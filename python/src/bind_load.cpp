#include <fmt/format.h>

#include "sinew/sim/model.hpp"
#include "sinew/sim/signal.hpp"
#include "sinew/sim/simulation.hpp"

#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const sim::LoadModel& model(const Load& self) {
  return self.session->model().loads()[static_cast<std::size_t>(self.index)];
}

double factor(const Load& self) {
  const Session::Use use(*self.session);
  const sim::Simulation& simulation = self.session->simulation();
  return simulation.load_factor(self.index).value(simulation.time());
}

void set_factor(const Load& self, const py::object& value) {
  const sim::Signal signal =
      to_signal(value, fmt::format("load('{}').factor", model(self).name), "");
  const Session::Use use(*self.session);
  self.session->simulation().set_load(self.index, signal);
}

}  // namespace

void bind_load(py::module_& module) {
  py::class_<Load>(module, "Load", "An external load of the scene. From Simulation.load().")
      .def_property_readonly(
          "name", [](const Load& self) { return model(self).name; }, "str: name in the scene.")
      .def_property(
          "factor", &factor, &set_factor,
          "float: present load factor; for a pressure the pressure in Pa. Assignment sets it from "
          "the next step on: a number, a signal such as `sinew.Ramp`, or (n, 2) samples of time "
          "and value.")
      .def("__repr__",
           [](const Load& self) { return fmt::format("<sinew.Load '{}'>", model(self).name); });
}

}  // namespace sinew::python
