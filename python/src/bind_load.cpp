#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/scene/load_kind.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const model::LoadModel& model(const Load& self) {
  return self.session->model().loads()[static_cast<std::size_t>(self.index)];
}

// The load in the scene; its factor is that of the scene file.
const scene::LoadDescription& description(const Load& self) {
  return *std::ranges::find(self.session->robot().robot.description.loads, model(self).name,
                            &scene::LoadDescription::name);
}

const scene::LoadKind& kind(const Load& self) { return *description(self).kind; }

std::string place(const Load& self, const char* attribute) {
  return fmt::format("load('{}').{}", model(self).name, attribute);
}

// Requires a load whose value is called `quantity`, which is the name of an attribute.
void require(const Load& self, const char* quantity) {
  const char* own = kind(self).quantity;
  if (std::string_view(own) == quantity) return;
  throw Error(ErrorKind::wrong_type, {.item = place(self, quantity)},
              fmt::format("this load has a {}", own), fmt::format("use .{}", own));
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
  return kind(self).signal_is_value() ? value / unit_pressure(self) : value;
}

void set_factor(const Load& self, const py::object& value) {
  const std::string where = place(self, "factor");
  if (!kind(self).signal_is_value()) return set(self, to_signal(value, where, ""));
  const double unit = unit_pressure(self);
  const model::Signal signal = to_signal(value, where, "");
  if (!signal.is_constant()) {
    throw Error(ErrorKind::wrong_type, {.item = where},
                "the factor of a pressure is a number, and this changes over time",
                "give the pressure over time, in Pa, to .pressure");
  }
  set(self, model::Signal::constant(unit * signal.value(0.0)));
}

const Vector3& written_vector(const Load& self) { return kind(self).vector(description(self)); }

Array vector(const Load& self, const char* quantity) {
  require(self, quantity);
  return reading(Vector3(present(self) * written_vector(self)));
}

// A load keeps its direction; the factor along it is set.
void set_vector(const Load& self, const char* quantity, const py::object& value) {
  require(self, quantity);
  const std::string where = place(self, quantity);
  const Vector3 wanted = to_vector3(value, where, "(3,)");
  const Vector3& own = written_vector(self);
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
  require(self, "pressure");
  return present(self);
}

void set_pressure(const Load& self, const py::object& value) {
  require(self, "pressure");
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
  py::class_<Load> load(module, "Load", "An external load of the scene. From Simulation.load().");
  load.def_property_readonly(
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
      .def("__repr__",
           [](const Load& self) { return fmt::format("<sinew.Load '{}'>", model(self).name); });
  const std::pair<const char*, const char*> vectors[] = {
      {"force", "N"}, {"force_per_length", "N/m"}, {"traction", "Pa"}, {"acceleration", "m/s^2"}};
  for (const auto& [quantity, unit] : vectors) {
    load.def_property(
        quantity, [quantity = quantity](const Load& self) { return vector(self, quantity); },
        [quantity = quantity](const Load& self, const py::object& value) {
          set_vector(self, quantity, value);
        },
        text(unit).c_str());
  }
}

}  // namespace sinew::python
