#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/chamber.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/row_efforts.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

using model::CommandKind;

const model::ActuatorModel& model(const Actuator& self) {
  return self.session->model().actuators()[static_cast<std::size_t>(self.index)];
}

std::string place(const Actuator& self, const char* what) {
  return fmt::format("actuator('{}').{}", model(self).name, what);
}

[[noreturn]] void fail_type(const Actuator& self, const char* what) {
  const model::ActuatorModel& own = model(self);
  std::string has = fmt::format(".{} and .{}", own.kind->effort.name, own.kind->motion.name);
  if (own.drive != nullptr && *own.drive->input().name != '\0') {
    has += fmt::format(" and .{}", own.drive->input().name);
  }
  throw Error(ErrorKind::wrong_actuator_type, {.item = place(self, what)},
              fmt::format("'{}' is a {}, which has no {}", own.name, own.kind->word, what),
              fmt::format("it has {}", has));
}

const constraint::Cable& cable(const Actuator& self, const char* what) {
  const constraint::Cable* found = self.session->model().cable(self.index);
  if (found == nullptr) fail_type(self, what);
  return *found;
}

const constraint::Chamber& chamber(const Actuator& self, const char* what) {
  const constraint::Chamber* found = self.session->model().chamber(self.index);
  if (found == nullptr) fail_type(self, what);
  return *found;
}

template <typename Get>
auto read(const Actuator& self, Get get) {
  const Session::Use use(*self.session);
  return get(self.session->simulation().actuator(self.index));
}

void tell(const Actuator& self, const char* what, const py::object& value) {
  const std::optional<CommandKind> kind = model(self).kind_of(what);
  if (!kind) fail_type(self, what);
  const model::Signal signal =
      to_signal(value, place(self, what), model(self).quantity(*kind).unit);
  const bool pushes = model(self).kind->pulls_only && *kind == CommandKind::effort &&
                      signal.is_constant() && signal.value(0.0) < 0.0;
  if (pushes) {
    throw Error(ErrorKind::out_of_range, {.item = place(self, what)},
                fmt::format("a tension of {:g} N would push", signal.value(0.0)),
                "give zero or more; a cable can only pull");
  }
  if (std::string_view(model(self).quantity(*kind).unit) == "Pa") {
    self.session->note_pressure(place(self, what), signal);
  }
  const Session::Use use(*self.session);
  self.session->simulation().command(self.index, {*kind, signal});
}

double effort(const Actuator& self, const char* what) {
  if (std::string_view(model(self).kind->effort.name) != what) fail_type(self, what);
  const Session::Use use(*self.session);
  return sim::end_effort(self.session->simulation(), model(self).row);
}

double motion(const Actuator& self, const char* what) {
  if (std::string_view(model(self).kind->motion.name) != what) fail_type(self, what);
  return read(self, [](const model::ActuatorState& state) { return state.motion; });
}

/// Entry `index` in the state of a drive with the input `input`.
double drive_number(const Actuator& self, const char* input, const char* what, std::size_t index) {
  const auto& drive = model(self).drive;
  if (drive == nullptr || std::string_view(drive->input().name) != input) fail_type(self, what);
  const Session::Use use(*self.session);
  return self.session->simulation().drive_state(self.index)[index];
}

double added_gas(const Actuator& self) {
  double now = drive_number(self, "gas", "gas", 0);
  double rest = 0.0;
  model(self).drive->rest({&rest, 1});
  return now - rest;
}

/// State of a shape-memory wire: temperature (index 0) or austenite fraction (index 1).
double wire_number(const Actuator& self, const char* what, std::size_t index) {
  const auto& drive = model(self).drive;
  if (drive == nullptr || drive->state_size() != 2) fail_type(self, what);
  const Session::Use use(*self.session);
  return self.session->simulation().drive_state(self.index)[index];
}

/// The commanded value of an input; 0 if another quantity is commanded.
double told(const Actuator& self, const char* what) {
  if (std::string_view(model(self).input_name().name) != what) fail_type(self, what);
  const Session::Use use(*self.session);
  const auto& command = self.session->simulation().actuator(self.index).command;
  return command.kind == CommandKind::input
             ? command.signal.value(self.session->simulation().time())
             : 0.0;
}

py::tuple command(const Actuator& self) {
  const Session::Use use(*self.session);
  const model::Command& command = self.session->simulation().actuator(self.index).command;
  const char* kind = model(self).quantity(command.kind).name;
  if (command.signal.is_constant()) return py::make_tuple(kind, command.signal.value(0.0));
  return py::make_tuple(kind, py::cast(command.signal));
}

py::dict limits(const Actuator& self) {
  py::dict result;
  result[model(self).kind->effort.name] = py::cast(model(self).effort);
  result[model(self).kind->motion.name] = py::cast(model(self).motion);
  return result;
}

template <typename Measure>
auto of_cable(const char* what, Measure measure) {
  return [what, measure](const Actuator& self) {
    const constraint::Cable& found = cable(self, what);
    const Session::Use use(*self.session);
    return measure(found, self.session->simulation().configuration());
  };
}

void bind_limits(py::module_& module) {
  py::class_<model::Limits>(module, "Limits", "Inclusive limits; infinite if unlimited.")
      .def_readonly("min", &model::Limits::min, "float: N, m, Pa or m^3.")
      .def_readonly("max", &model::Limits::max, "float: N, m, Pa or m^3.")
      .def_readonly("rate", &model::Limits::rate, "float: largest change per second.")
      .def("__repr__", [](const model::Limits& self) {
        return fmt::format("Limits(min={:g}, max={:g}, rate={:g})", self.min, self.max, self.rate);
      });
}

template <typename Get>
void bind_quantity(py::class_<Actuator>& type, const char* name, Get get, const char* text) {
  type.def_property(
      name, [name, get](const Actuator& self) { return get(self, name); },
      [name](const Actuator& self, const py::object& value) { tell(self, name, value); }, text);
}

/// The conjugate quantities that every kind of actuator has, under whichever names.
void bind_conjugates(py::class_<Actuator>& type) {
  type.def_property(
          "effort",
          [](const Actuator& self) { return effort(self, model(self).kind->effort.name); },
          [](const Actuator& self, const py::object& value) {
            tell(self, model(self).kind->effort.name, value);
          },
          "float: effort of an actuator of any type: tension, force (N), pressure (Pa) or torque "
          "(N "
          "m). Assignment sets the command, as for `displacement`.")
      .def_property(
          "motion",
          [](const Actuator& self) { return motion(self, model(self).kind->motion.name); },
          [](const Actuator& self, const py::object& value) {
            tell(self, model(self).kind->motion.name, value);
          },
          "float: motion of an actuator of any type: displacement (m), growth of volume (m^3) or "
          "angle (rad). Assignment sets the command, as for `displacement`. Effort times motion is "
          "work.")
      .def_property_readonly(
          "quantities",
          [](const Actuator& self) {
            const model::ActuatorKind& kind = *model(self).kind;
            py::dict units;
            units[kind.effort.name] = kind.effort.unit;
            units[kind.motion.name] = kind.motion.unit;
            return units;
          },
          "dict: name and unit of the effort, then of the motion: {'tension': 'N', 'displacement': "
          "'m'}.")
      .def_property_readonly(
          "pulls_only", [](const Actuator& self) { return model(self).kind->pulls_only; },
          "bool: whether its effort is never negative, as a cable's; it may be slack.")
      .def_property_readonly(
          "regulates_effort",
          [](const Actuator& self) { return model(self).kind->regulates_effort; },
          "bool: whether it regulates its effort, as a valve does a pressure; others, such as "
          "winches, regulate their motion.")
      .def_property_readonly(
          "controllable", [](const Actuator& self) { return model(self).controllable(); },
          "bool: whether a controller may choose its effort; false for a spring.");
}

void bind_commands(py::class_<Actuator>& type) {
  bind_quantity(
      type, "displacement", motion,
      R"(float: length of cable pulled out of the robot, or displacement of a force's point along its direction (m).

Reading returns the present value; assignment sets the command: a number (m), a signal such as
`sinew.Ramp`, or (n, 2) samples of time and value. The actuator follows within its limits. Raises
Error (actuator-owned) while a controller owns the actuator.)");
  bind_quantity(
      type, "tension", effort,
      "float: tension of a cable (N), >= 0. Assignment sets the command, as for "
      "`displacement`. For a spring, which takes no command, it is negative when the spring "
      "pushes.");
  bind_quantity(
      type, "force", effort,
      "float: force of a force actuator along its direction (N). Assignment sets the command, "
      "as for `displacement`.");
  bind_quantity(
      type, "pressure", effort,
      "float: pressure of a chamber above ambient (Pa). Assignment sets the command, as for "
      "`displacement`; if the chamber has a supply, the pressure approaches it through the "
      "supply.");
  bind_quantity(
      type, "torque", effort,
      "float: torque on the bend of a segment, or of a motor on its joint (N m). Assignment "
      "sets the command, as for `displacement`.");
  bind_quantity(
      type, "angle", motion,
      "float: angle of the bent segment, or of a motor's joint (rad). Assignment sets the "
      "command.");
  bind_quantity(
      type, "velocity", told,
      "float: commanded velocity of a motor (rad/s, m/s), 0 while another quantity is "
      "commanded. Assignment sets the command; the joint follows within the limits on the "
      "motor's effort.");
  bind_quantity(
      type, "volume_growth", motion,
      "float: volume gained by a chamber from rest (m^3). Assignment sets the command, as a "
      "syringe filled with liquid does.");
  bind_quantity(
      type, "gas", [](const Actuator& self, const char*) { return added_gas(self); },
      "float: gas added to a chamber from rest, as a volume at ambient pressure (m^3). "
      "Assignment sets the command, as for `displacement`. Only for chambers with `gas`.");
  bind_quantity(
      type, "liquid",
      [](const Actuator& self, const char*) { return drive_number(self, "liquid", "liquid", 0); },
      "float: liquid added to a chamber (m^3). Assignment sets the command. Only for chambers "
      "with `liquid`.");
  bind_quantity(type, "power", told,
                "float: electric power of a shape-memory spring (W). Assignment sets the command.");
  bind_quantity(
      type, "phase",
      [](const Actuator& self, const char*) { return wire_number(self, "phase", 1); },
      "float: austenite fraction of a shape-memory spring, 0 to 1. Assignment sets the command "
      "if the scene allows it.");
  type.def_property_readonly(
          "temperature", [](const Actuator& self) { return wire_number(self, "temperature", 0); },
          "float: temperature of a shape-memory spring (K).")
      .def_property_readonly(
          "volume",
          [](const Actuator& self) {
            const double rest = chamber(self, "volume").rest_volume();
            return rest + motion(self, "volume_growth");
          },
          "float: present volume of a chamber (m^3), without dead volume.")
      .def_property_readonly("command", &command,
                             "tuple: the command, such as ('displacement', 0.01): the quantity and "
                             "a number or a Signal.")
      .def_property_readonly(
          "owned",
          [](const Actuator& self) {
            return read(self,
                        [](const model::ActuatorState& state) { return state.owner != nullptr; });
          },
          "bool: whether a controller owns it. Commands then raise an error.");
}

void bind_measures(py::class_<Actuator>& type) {
  using constraint::Cable;
  using constraint::Configuration;
  type.def_property_readonly(
          "slack",
          [](const Actuator& self) {
            return read(self, [](const model::ActuatorState& state) { return state.slack; });
          },
          "bool: whether a cable is slack (tension zero).")
      .def_property_readonly(
          "length",
          of_cable("length",
                   [](const Cable& c, const Configuration& now) { return c.length(now); }),
          "float: present length of a cable from its pull point to its end (m).")
      .def_property_readonly(
          "rest_length",
          of_cable("rest_length",
                   [](const Cable& c, const Configuration&) { return c.rest_length(); }),
          "float: length of a cable at rest (m); displacement = rest_length - length.")
      .def_property_readonly(
          "wrap",
          of_cable("wrap", [](const Cable& c, const Configuration& now) { return c.wrap(now); }),
          "float: sum of the angles by which a cable turns at its via points (rad).")
      .def_property_readonly(
          "tensions",
          [](const Actuator& self) {
            const constraint::Cable& found = cable(self, "tensions");
            const Session::Use use(*self.session);
            const auto values = found.tensions(sim::end_efforts(self.session->simulation()));
            return read_only(Array(static_cast<py::ssize_t>(values.size()), values.data()));
          },
          "(n - 1,) ndarray: tension of every segment of a cable, starting at the pull point (N). "
          "They differ by the friction at the points between; the last one acts on the fixed end.")
      .def_property_readonly(
          "points",
          of_cable("points",
                   [](const Cable& c, const Configuration& now) { return reading(c.points(now)); }),
          "(n, 3) ndarray: present points of a cable, the pull point first (m).")
      .def_property_readonly("limits", &limits,
                             "dict: Limits of the effort ('tension', 'force' or 'pressure') and of "
                             "the motion ('displacement' or 'volume_growth').");
}

}  // namespace

void bind_actuator(py::module_& module) {
  bind_limits(module);
  py::class_<Actuator> type(
      module, "Actuator",
      "An actuator of the robot, such as a cable, chamber, force, motor or spring. From "
      "Simulation.actuator().");
  type.def_property_readonly(
          "name", [](const Actuator& self) { return model(self).name; }, "str: name in the scene.")
      .def_property_readonly(
          "type", [](const Actuator& self) { return model(self).kind->word; },
          "str: 'cable', 'force', 'chamber', 'spring', 'torque', 'motor' or 'linear-motor'.")
      .def("__repr__", [](const Actuator& self) {
        return fmt::format("<sinew.Actuator '{}', a {}>", model(self).name, model(self).kind->word);
      });
  bind_conjugates(type);
  bind_commands(type);
  bind_measures(type);
}

}  // namespace sinew::python
