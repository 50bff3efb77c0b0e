#include <fmt/format.h>

#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const model::MassModel& model(const PointMass& self) {
  return self.session->model().masses()[static_cast<std::size_t>(self.index)];
}

const mechanics::Body& carrier(const PointMass& self) {
  return self.session->simulation().body(model(self).body);
}

}  // namespace

void bind_mass(py::module_& module) {
  py::class_<PointMass>(module, "PointMass",
                        "A point mass on a body. From Simulation.mass() or Simulation.masses.")
      .def_property_readonly(
          "name", [](const PointMass& self) { return model(self).name; }, "str: name in the scene.")
      .def_property_readonly(
          "body",
          [](const PointMass& self) { return self.session->model().body(model(self).body).name(); },
          "str: name of the body that carries it.")
      .def_property_readonly(
          "mass", [](const PointMass& self) { return model(self).mass; }, "float: kg.")
      .def_property_readonly(
          "position",
          [](const PointMass& self) {
            const Session::Use use(*self.session);
            return reading(carrier(self).position(model(self).point));
          },
          "(3,) ndarray: present position (m). A copy.")
      .def_property_readonly(
          "velocity",
          [](const PointMass& self) {
            const Session::Use use(*self.session);
            return reading(carrier(self).velocity(model(self).point));
          },
          "(3,) ndarray: present velocity (m/s). A copy.")
      .def("__repr__", [](const PointMass& self) {
        return fmt::format("<sinew.PointMass '{}', {:g} kg>", model(self).name, model(self).mass);
      });
}

}  // namespace sinew::python
