#include <fmt/format.h>

#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/joint_load.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const model::JointModel& model(const Joint& self) {
  return self.session->model().joints()[static_cast<std::size_t>(self.index)];
}

std::string body_name(const Joint& self, int body) {
  if (body == model::kWorld) return "world";
  return self.session->model().body(body).name();
}

std::string type_name(const Joint& self) {
  const auto* joint = self.session->model().joint(self.index);
  return joint == nullptr ? "weld" : constraint::joint_type_name(joint->type());
}

void require_motion(const Joint& self, std::size_t which, const char* name) {
  if (model(self).motions[which] >= 0) return;
  throw py::attribute_error(
      fmt::format("joint '{}' is a {} and has no {}", model(self).name, type_name(self), name));
}

double limit_effort(const Joint& self, std::size_t which, const char* name) {
  require_motion(self, which, name);
  const Session::Use use(*self.session);
  return sim::joint_limit_effort(self.session->simulation(), self.index, which);
}

double friction_effort(const Joint& self) {
  const Session::Use use(*self.session);
  return sim::joint_friction_effort(self.session->simulation(), self.index);
}

double motion(const Joint& self, std::size_t which, const char* name) {
  require_motion(self, which, name);
  const Session::Use use(*self.session);
  return sim::joint_motion(self.session->simulation(), self.index, which);
}

sim::JointLoad load(const Joint& self) {
  const Session::Use use(*self.session);
  return sim::joint_load(self.session->simulation(), self.index);
}

}  // namespace

void bind_joint(py::module_& module) {
  py::class_<Joint>(
      module, "Joint",
      "A joint between two bodies, or between a body and the world. From Simulation.joint() or "
      "Simulation.joints.")
      .def_property_readonly(
          "name", [](const Joint& self) { return model(self).name; }, "str: name in the scene.")
      .def_property_readonly(
          "bodies",
          [](const Joint& self) {
            return py::make_tuple(body_name(self, model(self).first),
                                  body_name(self, model(self).second));
          },
          "(str, str): the two bodies, as in the scene; 'world' for the world.")
      .def_property_readonly("type", type_name,
                             "str: 'weld', 'ball', 'hinge', 'slider', 'cylindrical' or "
                             "'universal'.")
      .def_property_readonly(
          "angle", [](const Joint& self) { return motion(self, 0, "angle"); },
          "float: angle of a hinge or cylindrical joint: the second body relative to the first, "
          "right-handed about the axis (rad). 0 at the start; counts whole turns. Raises "
          "AttributeError for other joints.")
      .def_property_readonly(
          "displacement", [](const Joint& self) { return motion(self, 1, "displacement"); },
          "float: displacement of a slider or cylindrical joint: the second body relative to the "
          "first along the axis (m). 0 at the start. Raises AttributeError for other joints.")
      .def_property_readonly(
          "force", [](const Joint& self) { return reading(load(self).force); },
          "(3,) ndarray: constraint force on the second body at the end of the last step (N), "
          "without motors, limits and friction.")
      .def_property_readonly(
          "moment", [](const Joint& self) { return reading(load(self).moment); },
          "(3,) ndarray: constraint moment about `centre` on the second body (N m).")
      .def_property_readonly(
          "limit_torque", [](const Joint& self) { return limit_effort(self, 0, "limit_torque"); },
          "float: torque of the limits of the angle on the second body in the last step (N m), "
          "positive in the direction of a growing angle; 0 away from the limits. Raises "
          "AttributeError for joints without an angle.")
      .def_property_readonly(
          "limit_force", [](const Joint& self) { return limit_effort(self, 1, "limit_force"); },
          "float: force of the limits of the displacement on the second body in the last step (N), "
          "positive in the direction of a growing displacement; 0 away from the limits. Raises "
          "AttributeError for joints without a displacement.")
      .def_property_readonly(
          "friction_effort", friction_effort,
          "float: torque (hinge, N m) or force (slider, N) of the joint's friction on the second "
          "body in the last step, positive in the direction of a growing angle or displacement; it "
          "opposes the motion. 0 without friction.")
      .def_property_readonly(
          "centre", [](const Joint& self) { return reading(load(self).centre); },
          "(3,) ndarray: present position of the joint on its second body, for a weld the mean of "
          "its points (m).")
      .def_property_readonly(
          "gap", [](const Joint& self) { return load(self).gap; },
          "float: largest distance between two joined points (m).")
      .def("__repr__", [](const Joint& self) {
        const std::string first = body_name(self, model(self).first);
        const std::string second = body_name(self, model(self).second);
        if (const auto* tie = self.session->model().tie(self.index)) {
          return fmt::format("<sinew.Joint '{}', {} points of '{}' welded to '{}'>",
                             model(self).name, tie->pairs().size(), first, second);
        }
        return fmt::format("<sinew.Joint '{}', {} of '{}' and '{}'>", model(self).name,
                           type_name(self), first, second);
      });
}

}  // namespace sinew::python
