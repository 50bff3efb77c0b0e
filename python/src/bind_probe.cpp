#include <fmt/format.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

const constraint::Probe& model(const Probe& self) {
  return self.session->model().probe(self.index);
}

bool is_line(const Probe& self) {
  return dynamic_cast<const constraint::LineProbe*>(&model(self)) != nullptr;
}

py::object value(const Probe& self) {
  const Session::Use use(*self.session);
  const std::vector<double> values = self.session->simulation().probe_values(self.index);
  if (values.size() == 1 || is_line(self)) return py::float_(values.front());
  const auto count = static_cast<Eigen::Index>(values.size());
  return reading(VectorX(Eigen::Map<const VectorX>(values.data(), count)));
}

Array positions(const Probe& self) {
  const Session::Use use(*self.session);
  return reading(model(self).marks(self.session->simulation().configuration()));
}

}  // namespace

void bind_probe(py::module_& module) {
  py::class_<Probe>(
      module, "Probe",
      "A probe: a measurement that does not affect the robot. From Simulation.probe() or "
      "Simulation.probes.")
      .def_property_readonly(
          "name", [](const Probe& self) { return model(self).name(); }, "str: name in the scene.")
      .def_property_readonly(
          "kind", [](const Probe& self) { return model(self).kind(); },
          "str: 'point', 'line', 'bend', 'distance' or 'extent'.")
      .def_property_readonly(
          "unit", [](const Probe& self) { return model(self).components().front().unit; },
          "str: 'm', or 'rad' for a bend.")
      .def_property_readonly(
          "value", &value,
          "float: present value (m or rad); for a line its length. (3,) ndarray for a point (m).")
      .def_property_readonly(
          "positions", &positions,
          "(k, 3) ndarray: present measuring points (m): the point; the points along a line; the "
          "ends of a distance; the two outermost nodes of an extent; the centres of a bend's "
          "faces. A copy.")
      .def("__repr__", [](const Probe& self) {
        return fmt::format("<sinew.Probe '{}', {}>", model(self).name(), model(self).kind());
      });
}

}  // namespace sinew::python
