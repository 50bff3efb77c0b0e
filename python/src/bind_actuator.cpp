#include <limits>

#include <fmt/format.h>

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using sim::ActuatorType;
using sim::CommandKind;

const sim::ActuatorModel& model(const Actuator& self) {
  return self.session->model().actuators()[static_cast<std::size_t>(self.index)];
}

std::string place(const Actuator& self, const char* what) {
  return fmt::format("actuator('{}').{}", model(self).name, what);
}

void require(const Actuator& self, ActuatorType type, const char* what) {
  if (model(self).type == type) return;
  throw Error(ErrorKind::wrong_actuator_type, {.item = place(self, what)},
              fmt::format("'{}' is a {}, which has no {}", model(self).name,
                          sim::actuator_type_name(model(self).type), what),
              model(self).type == ActuatorType::force ? "a force has .force and .displacement"
                                                      : "a cable has .tension and .displacement");
}

const constraint::Cable& cable(const Actuator& self, const char* what) {
  require(self, ActuatorType::cable, what);
  return *self.session->model().cable(self.index);
}

template <typename Get>
auto read(const Actuator& self, Get get) {
  const Session::Use use(*self.session);
  return get(self.session->simulation().actuator(self.index));
}

void tell(const Actuator& self, CommandKind kind, const char* what, const py::object& value) {
  const bool cable = model(self).type == ActuatorType::cable;
  const sim::Signal signal =
      to_signal(value, place(self, what), kind == CommandKind::effort ? "N" : "m");
  if (cable && kind == CommandKind::effort && signal.is_constant() && signal.value(0.0) < 0.0) {
    throw Error(ErrorKind::out_of_range, {.item = place(self, what)},
                fmt::format("a tension of {:g} N would push", signal.value(0.0)),
                "give zero or more; a cable can only pull");
  }
  const Session::Use use(*self.session);
  self.session->simulation().command(self.index, {kind, signal});
}

double effort(const Actuator& self, ActuatorType type, const char* what) {
  require(self, type, what);
  return read(self, [](const sim::ActuatorState& state) { return state.effort; });
}

py::tuple command(const Actuator& self) {
  const Session::Use use(*self.session);
  const sim::Command& command = self.session->simulation().actuator(self.index).command;
  const char* kind = command.kind == CommandKind::effort ? model(self).effort_name()
                                                         : sim::ActuatorModel::motion_name();
  if (command.signal.is_constant()) return py::make_tuple(kind, command.signal.value(0.0));
  return py::make_tuple(kind, py::cast(command.signal));
}

py::dict limits(const Actuator& self) {
  py::dict result;
  result[model(self).effort_name()] = py::cast(model(self).effort);
  result[sim::ActuatorModel::motion_name()] = py::cast(model(self).motion);
  return result;
}

template <typename Measure>
auto of_cable(const char* what, Measure measure) {
  return [what, measure](const Actuator& self) {
    const constraint::Cable& found = cable(self, what);
    const Session::Use use(*self.session);
    return measure(found, self.session->simulation().world().placement());
  };
}

void bind_limits(py::module_& module) {
  py::class_<sim::Limits>(module, "Limits", "Inclusive limits; infinite where there is none.")
      .def_readonly("min", &sim::Limits::min, "float: N or m.")
      .def_readonly("max", &sim::Limits::max, "float: N or m.")
      .def_readonly("rate", &sim::Limits::rate, "float: largest change, N/s or m/s.")
      .def("__repr__", [](const sim::Limits& self) {
        return fmt::format("Limits(min={:g}, max={:g}, rate={:g})", self.min, self.max, self.rate);
      });
}

void bind_commands(py::class_<Actuator>& type) {
  type.def_property(
          "displacement",
          [](const Actuator& self) {
            return read(self, [](const sim::ActuatorState& state) { return state.motion; });
          },
          [](const Actuator& self, const py::object& value) {
            tell(self, CommandKind::motion, "displacement", value);
          },
          R"(float: length pulled out of the robot, or travel of a force's point along it (m).

Reading gives what it is; assigning commands it: a number (m), a signal such as `sinew.Ramp`, or
(n, 2) samples of time and value. The actuator obeys within its limits. Raises Error
(actuator-owned) while a controller has it.)")
      .def_property(
          "tension",
          [](const Actuator& self) { return effort(self, ActuatorType::cable, "tension"); },
          [](const Actuator& self, const py::object& value) {
            require(self, ActuatorType::cable, "tension");
            tell(self, CommandKind::effort, "tension", value);
          },
          "float: tension of a cable (N), >= 0. Assigning commands it, as for `displacement`.")
      .def_property(
          "force", [](const Actuator& self) { return effort(self, ActuatorType::force, "force"); },
          [](const Actuator& self, const py::object& value) {
            require(self, ActuatorType::force, "force");
            tell(self, CommandKind::effort, "force", value);
          },
          "float: force of a force actuator along its direction (N). Assigning commands it, as for "
          "`displacement`.")
      .def_property_readonly("command", &command,
                             "tuple: what it is told, as ('displacement', 0.01): the quantity and "
                             "a number or a Signal.")
      .def_property_readonly(
          "owned",
          [](const Actuator& self) {
            return read(self,
                        [](const sim::ActuatorState& state) { return state.owner != nullptr; });
          },
          "bool: whether a controller has it, so that commands raise.");
}

void bind_measures(py::class_<Actuator>& type) {
  using constraint::Cable;
  using constraint::Placement;
  type.def_property_readonly(
          "slack",
          [](const Actuator& self) {
            return read(self, [](const sim::ActuatorState& state) { return state.slack; });
          },
          "bool: a cable without tension.")
      .def_property_readonly(
          "length",
          of_cable("length", [](const Cable& c, const Placement& p) { return c.length(p); }),
          "float: length of a cable from its pull point to its end now (m).")
      .def_property_readonly(
          "rest_length",
          of_cable("rest_length", [](const Cable& c, const Placement&) { return c.rest_length(); }),
          "float: length of a cable at rest (m); displacement = rest_length - length.")
      .def_property_readonly(
          "wrap", of_cable("wrap", [](const Cable& c, const Placement& p) { return c.wrap(p); }),
          "float: sum of the angles by which a cable turns at its via points (rad).")
      .def_property_readonly(
          "points",
          of_cable("points", [](const Cable& c, const Placement& p) { return copy(c.points(p)); }),
          "(n, 3) ndarray: a cable's points now, pull point first (m).")
      .def_property_readonly("limits", &limits,
                             "dict: Limits of the effort ('tension' or 'force') and of the "
                             "'displacement'.");
}

}  // namespace

void bind_actuator(py::module_& module) {
  bind_limits(module);
  py::class_<Actuator> type(module, "Actuator",
                            "What drives a robot: a cable or a force. From Simulation.actuator().");
  type.def_property_readonly(
          "name", [](const Actuator& self) { return model(self).name; }, "str: as in the scene.")
      .def_property_readonly(
          "type", [](const Actuator& self) { return sim::actuator_type_name(model(self).type); },
          "str: 'cable' or 'force'.")
      .def("__repr__", [](const Actuator& self) {
        return fmt::format("<sinew.Actuator '{}', a {}>", model(self).name,
                           sim::actuator_type_name(model(self).type));
      });
  bind_commands(type);
  bind_measures(type);
}

}  // namespace sinew::python
