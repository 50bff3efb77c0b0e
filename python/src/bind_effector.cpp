#include <fmt/format.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const constraint::Effector& model(const Effector& self) {
  return self.session->model().effector(self.index);
}

bool is_orientation(const Effector& self) {
  return model(self).kind() == constraint::EffectorKind::orientation;
}

Array value(const Effector& self) {
  const Session::Use use(*self.session);
  return reading(self.session->simulation().effector_value(self.index));
}

Array value_of(const Effector& self, bool orientation) {
  if (is_orientation(self) != orientation) {
    const char* has = orientation ? "position" : "rotation";
    const char* asked = orientation ? "rotation" : "position";
    throw Error(ErrorKind::wrong_type,
                {.item = fmt::format("effector('{}').{}", model(self).name(), asked)},
                fmt::format("this effector measures a {}", has), fmt::format("use .{}", has));
  }
  return value(self);
}

// Velocity of the point for positions, angular velocity for orientations.
Array velocity(const Effector& self) {
  const Session::Use use(*self.session);
  const sim::Simulation& simulation = self.session->simulation();
  if (const auto* point = dynamic_cast<const constraint::PointEffector*>(&model(self))) {
    return reading(simulation.configuration().velocity(point->point()));
  }
  const auto& pattern = self.session->model().rows();
  Vector3 turn = Vector3::Zero();
  for (int k = 0; k < model(self).row_count(); ++k) {
    const auto row = static_cast<std::size_t>(model(self).first_row() + k);
    for (auto e = pattern.row_start[row]; e < pattern.row_start[row + 1]; ++e) {
      const auto entry = static_cast<std::size_t>(e);
      turn[k] += simulation.world().rows().direction[entry].dot(
          simulation.configuration().velocity(pattern.site[entry]));
    }
  }
  return reading(turn);
}

Array directions(const Effector& self) {
  const auto& rows = model(self).directions();
  Points points(static_cast<Eigen::Index>(rows.size()), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) = rows[static_cast<std::size_t>(i)].transpose();
  }
  return reading(points);
}

}  // namespace

void bind_effector(py::module_& module) {
  py::class_<Effector>(module, "Effector",
                       "A controlled or recorded point or orientation. From Simulation.effector().")
      .def_property_readonly(
          "name", [](const Effector& self) { return model(self).name(); },
          "str: name in the scene.")
      .def_property_readonly(
          "position", [](const Effector& self) { return value_of(self, false); },
          "(3,) ndarray: present position of the point, or of the mean of the points (m). A "
          "read-only copy.")
      .def_property_readonly(
          "rotation", [](const Effector& self) { return value_of(self, true); },
          "(3,) ndarray: rotation vector of an orientation effector relative to rest (rad). A "
          "read-only copy.")
      .def_property_readonly("velocity", &velocity,
                             "(3,) ndarray: velocity (m/s), or angular velocity of an orientation "
                             "effector (rad/s); zero in quasi-static runs.")
      .def_property_readonly("value", &value,
                             "(3,) ndarray: position or rotation, depending on the kind.")
      .def_property_readonly(
          "unit", [](const Effector& self) { return model(self).unit(); }, "str: 'm' or 'rad'.")
      .def_property_readonly("directions", &directions,
                             "(k, 3) ndarray: unit vectors of the controlled directions.")
      .def("__repr__", [](const Effector& self) {
        return fmt::format("<sinew.Effector '{}'>", model(self).name());
      });
}

}  // namespace sinew::python
