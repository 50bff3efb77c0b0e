#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

using Type = scene::LoadDescription::Type;

const model::LoadModel& model(const Load& self) {
  return self.session->model().loads()[static_cast<std::size_t>(self.index)];
}

// The load in the scene; its factor is that of the scene file.
const scene::LoadDescription& description(const Load& self) {
  return *std::ranges::find(self.session->robot().robot.description.loads, model(self).name,
                            &scene::LoadDescription::name);
}

// The attribute that has the value of a load of this type.
const char* quantity(Type type) {
  switch (type) {
    case Type::force:
      return "force";
    case Type::line:
      return "force_per_length";
    case Type::traction:
      return "traction";
    case Type::acceleration:
      return "acceleration";
    case Type::pressure:
      return "pressure";
    case Type::water:
      return "factor";
  }
  return "factor";
}

std::string place(const Load& self, const char* attribute) {
  return fmt::format("load('{}').{}", model(self).name, attribute);
}

void require(const Load& self, Type type) {
  const Type own = description(self).type;
  if (own == type) return;
  throw Error(ErrorKind::wrong_type, {.item = place(self, quantity(type))},
              fmt::format("this load has a {}", quantity(own)),
              fmt::format("use .{}", quantity(own)));
}

// The signal of the model at the present time: a factor, or the pressure in Pa.
double present(const Load& self) {
  const Session::Use use(*self.session);
  const sim::Simulation& simulation = self.session->simulation();
  return simulation.load_factor(self.index).value(simulation.time());
}

void set(const Load& self, const model::Signal& signal) {
  const Session::Use use(*self.session);
  self.session->simulation().set_load(self.index, signal);
}

// The pressure of the scene to which a factor refers, Pa.
double unit_pressure(const Load& self) {
  const model::Signal& written = description(self).factor;
  if (written.is_constant() && written.value(0.0) != 0.0) return written.value(0.0);
  throw Error(
      ErrorKind::wrong_type, {.item = place(self, "factor")},
      "the pressure of this load in the scene is zero or changes over time, so that a factor "
      "of it has no meaning",
      "use .pressure, in Pa");
}

double factor(const Load& self) {
  const double value = present(self);
  return description(self).type == Type::pressure ? value / unit_pressure(self) : value;
}

void set_factor(const Load& self, const py::object& value) {
  const std::string where = place(self, "factor");
  if (description(self).type != Type::pressure) return set(self, to_signal(value, where, ""));
  const double unit = unit_pressure(self);
  const model::Signal signal = to_signal(value, where, "");
  if (!signal.is_constant()) {
    throw Error(ErrorKind::wrong_type, {.item = where},
                "the factor of a pressure is a number, and this changes over time",
                "give the pressure over time, in Pa, to .pressure");
  }
  set(self, model::Signal::constant(unit * signal.value(0.0)));
}

template <Type type>
Array vector(const Load& self) {
  require(self, type);
  return reading(Vector3(present(self) * description(self).vector));
}

// A load keeps its direction; the factor along it is set.
template <Type type>
void set_vector(const Load& self, const py::object& value) {
  require(self, type);
  const std::string where = place(self, quantity(type));
  const Vector3 wanted = to_vector3(value, where, "(3,)");
  const Vector3& own = description(self).vector;
  const double along = own.squaredNorm() > 0.0 ? wanted.dot(own) / own.squaredNorm() : 0.0;
  constexpr double kParallel = 1e-9;
  if ((wanted - along * own).norm() > kParallel * wanted.norm()) {
    throw Error(
        ErrorKind::out_of_range, {.item = where},
        fmt::format("({:g}, {:g}, {:g}) is not parallel to ({:g}, {:g}, {:g}), the value in "
                    "the scene",
                    wanted.x(), wanted.y(), wanted.z(), own.x(), own.y(), own.z()),
        "a load keeps its direction: write one load for each direction");
  }
  set(self, model::Signal::constant(along));
}

double pressure(const Load& self) {
  require(self, Type::pressure);
  return present(self);
}

void set_pressure(const Load& self, const py::object& value) {
  require(self, Type::pressure);
  const std::string where = place(self, "pressure");
  const model::Signal signal = to_signal(value, where, "Pa");
  self.session->note_pressure(where, signal);
  set(self, signal);
}

}  // namespace

void bind_load(py::module_& module) {
  constexpr const char* kVector =
      " of the type of this name: its value in the scene times `factor`. Read-only copy. "
      "Assignment "
      "of a parallel vector sets it from the next step on.";
  const auto text = [&](const char* unit) {
    return fmt::format("(3,) ndarray: present value ({}) of a load{}", unit, kVector);
  };
  py::class_<Load>(module, "Load", "An external load of the scene. From Simulation.load().")
      .def_property_readonly(
          "name", [](const Load& self) { return model(self).name; }, "str: name in the scene.")
      .def_property(
          "factor", &factor, &set_factor,
          "float: present load factor: 1 is the load of the scene. Assignment sets it from the "
          "next "
          "step on: a number, a signal such as `sinew.Ramp`, or (n, 2) samples of time and value. "
          "For a pressure, it refers to the constant pressure of the scene and is a number; "
          "Error (wrong-type) if the scene's pressure is zero or changes over time.")
      .def_property("pressure", &pressure, &set_pressure,
                    "float: present pressure (Pa) of a load of type pressure. Assignment sets it "
                    "from the next "
                    "step on: a number, a signal, or (n, 2) samples of time and value. Error "
                    "(wrong-type) for "
                    "other loads.")
      .def_property("force", &vector<Type::force>, &set_vector<Type::force>, text("N").c_str())
      .def_property("force_per_length", &vector<Type::line>, &set_vector<Type::line>,
                    text("N/m").c_str())
      .def_property("traction", &vector<Type::traction>, &set_vector<Type::traction>,
                    text("Pa").c_str())
      .def_property("acceleration", &vector<Type::acceleration>, &set_vector<Type::acceleration>,
                    text("m/s^2").c_str())
      .def("__repr__",
           [](const Load& self) { return fmt::format("<sinew.Load '{}'>", model(self).name); });
}

}  // namespace sinew::python
