#include <fmt/format.h>

#include "sinew/constraint/tie.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/weld_load.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const sim::WeldModel& model(const Joint& self) {
  return self.session->model().welds()[static_cast<std::size_t>(self.index)];
}

const std::string& body_name(const Joint& self, int body) {
  return self.session->model().body(body).name();
}

sim::WeldLoad load(const Joint& self) {
  const Session::Use use(*self.session);
  return sim::weld_load(self.session->simulation(), self.index);
}

}  // namespace

void bind_joint(py::module_& module) {
  py::class_<Joint>(module, "Joint",
                    "A weld: two bodies that are one. From Simulation.joint() or "
                    "Simulation.joints.")
      .def_property_readonly(
          "name", [](const Joint& self) { return model(self).name; }, "str: as in the scene.")
      .def_property_readonly(
          "bodies",
          [](const Joint& self) {
            return py::make_tuple(body_name(self, model(self).first),
                                  body_name(self, model(self).second));
          },
          "(str, str): the two bodies, as in the scene.")
      .def_property_readonly(
          "force", [](const Joint& self) { return copy(load(self).force); },
          "(3,) ndarray: the force on the second body in the last step (N).")
      .def_property_readonly(
          "moment", [](const Joint& self) { return copy(load(self).moment); },
          "(3,) ndarray: its moment about `centre` (N m).")
      .def_property_readonly(
          "centre", [](const Joint& self) { return copy(load(self).centre); },
          "(3,) ndarray: the mean of the welded points, now (m).")
      .def_property_readonly(
          "gap", [](const Joint& self) { return load(self).gap; },
          "float: the largest distance of two points that should be one (m).")
      .def("__repr__", [](const Joint& self) {
        return fmt::format("<sinew.Joint '{}', {} points of '{}' welded to '{}'>", model(self).name,
                           self.session->model().weld(self.index).pairs().size(),
                           body_name(self, model(self).first), body_name(self, model(self).second));
      });
}

}  // namespace sinew::python
