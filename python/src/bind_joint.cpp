#include <fmt/format.h>

#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/joint_load.hpp"
#include "sinew/sim/model.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const sim::JointModel& model(const Joint& self) {
  return self.session->model().joints()[static_cast<std::size_t>(self.index)];
}

std::string body_name(const Joint& self, int body) {
  if (body == sim::kWorld) return "world";
  return self.session->model().body(body).name();
}

std::string type_name(const Joint& self) {
  const auto* joint = self.session->model().joint(self.index);
  return joint == nullptr ? "weld" : constraint::joint_type_name(joint->type());
}

double motion(const Joint& self, std::size_t which, const char* name) {
  if (model(self).motions[which] < 0) {
    throw py::attribute_error(
        fmt::format("joint '{}' is a {} and has no {}", model(self).name, type_name(self), name));
  }
  const Session::Use use(*self.session);
  return sim::joint_motion(self.session->simulation(), self.index, which);
}

sim::JointLoad load(const Joint& self) {
  const Session::Use use(*self.session);
  return sim::joint_load(self.session->simulation(), self.index);
}

}  // namespace

void bind_joint(py::module_& module) {
  py::class_<Joint>(module, "Joint",
                    "What holds two bodies together, or a body to the world. From "
                    "Simulation.joint() or Simulation.joints.")
      .def_property_readonly(
          "name", [](const Joint& self) { return model(self).name; }, "str: as in the scene.")
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
          "float: of a hinge or cylindrical joint, the angle of the second body in the first, "
          "right-handed about the axis (rad). 0 at the start; whole turns count. Raises "
          "AttributeError for other joints.")
      .def_property_readonly(
          "displacement", [](const Joint& self) { return motion(self, 1, "displacement"); },
          "float: of a slider or cylindrical joint, that of the second body along the axis (m). 0 "
          "at the start. Raises AttributeError for other joints.")
      .def_property_readonly(
          "force", [](const Joint& self) { return copy(load(self).force); },
          "(3,) ndarray: the force that holds the second body in the last step (N). Motors, limits "
          "and friction act beside it.")
      .def_property_readonly(
          "moment", [](const Joint& self) { return copy(load(self).moment); },
          "(3,) ndarray: its moment about `centre` (N m).")
      .def_property_readonly(
          "centre", [](const Joint& self) { return copy(load(self).centre); },
          "(3,) ndarray: where the joint is now, on its second body; of welded points their mean "
          "(m).")
      .def_property_readonly(
          "gap", [](const Joint& self) { return load(self).gap; },
          "float: the largest distance of two points that should be one (m).")
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
