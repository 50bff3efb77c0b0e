// Binds the response of effectors to the efforts of controlled actuators.
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/controlled_response.hpp"

#include "arrays.hpp"
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

struct NamedResponse {
  std::vector<std::string> actuators;
  std::vector<std::string> effectors;
  sim::ControlledResponse response;
};

std::vector<int> to_controlled(const model::Model& model, const std::vector<std::string>& names) {
  std::vector<int> controlled;
  std::set<int> seen;
  for (const std::string& name : names) {
    const int actuator = model.actuator_index(name);
    if (!seen.insert(actuator).second) {
      throw Error(ErrorKind::bad_argument, {.item = "response(actuators)"},
                  fmt::format("'{}' is named twice", name), "name each actuator once");
    }
    controlled.push_back(actuator);
  }
  return controlled;
}

NamedResponse respond(Session& self, const std::optional<std::vector<std::string>>& names,
                      const std::string& tangent, bool geometric_stiffness, bool statics) {
  const model::Model& model = self.model();
  NamedResponse result;
  if (names) {
    result.actuators = *names;
  } else {
    for (const auto& actuator : model.actuators()) result.actuators.push_back(actuator.name);
  }
  for (const auto& effector : model.effectors()) result.effectors.push_back(effector.name);
  const std::vector<int> controlled = to_controlled(model, result.actuators);
  const sim::LinearisationChoice choice{to_tangent(tangent, "response(tangent)"),
                                        geometric_stiffness, statics};
  const Session::Use use(self);
  const py::gil_scoped_release others;
  result.response = sim::controlled_response(self.simulation(), controlled, choice);
  return result;
}

constexpr const char* kResponseDoc =
    R"(response($self, actuators=None, *, tangent='exact', geometric_stiffness=True, statics=True)
--

Response of effectors and actuators to the efforts of some actuators near the present state, while
everything else obeys its law: other actuators keep their commands, contact points and cables at their
guides keep sticking or sliding, joints hold. The state is not changed.

If every motion can be commanded, W_ea W_aa^-1 is the Jacobian of the effectors with respect to the actuators'
motions, as in the kinematics of soft robots (Zhang et al., IROS 2016).

Parameters
----------
actuators : list of str, optional
    Actuators whose efforts change; all by default.
tangent, geometric_stiffness, statics
    See linearise().

Returns
-------
Response
    `W_ea`, `W_aa`, `actuators`.

Raises
------
Error
    unknown-name; bad-argument: an actuator named twice.
RunError
    singular-matrix.
)";

}  // namespace

void bind_response(py::module_& module) {
  py::class_<NamedResponse>(module, "Response", "Result of Simulation.response().")
      .def_readonly("actuators", &NamedResponse::actuators,
                    "list of str: actuators whose efforts change, in the order of the columns.")
      .def_property_readonly(
          "W_ea",
          [](const NamedResponse& self) {
            py::dict result;
            for (std::size_t k = 0; k < self.effectors.size(); ++k) {
              result[self.effectors[k].c_str()] = reading(self.response.effectors[k]);
            }
            return result;
          },
          "dict: for each effector a (directions, actuators) ndarray, m/N (rad/N for orientations; "
          "per Pa for chambers, per N m for torques).")
      .def_property_readonly(
          "W_aa", [](const NamedResponse& self) { return reading(self.response.actuators); },
          "(actuators, actuators) ndarray: motions of the actuators, m/N (m^3/Pa, rad/(N m)). Not "
          "symmetric if anything slides.");
}

void bind_simulation_response(SimulationType& type) {
  type.def("response", &respond, py::arg("actuators") = py::none(), py::kw_only(),
           py::arg("tangent") = "exact", py::arg("geometric_stiffness") = true,
           py::arg("statics") = true, kResponseDoc);
}

}  // namespace sinew::python
