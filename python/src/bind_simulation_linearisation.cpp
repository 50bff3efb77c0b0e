// How motions of a simulation follow from efforts.
#include <string>

#include "sinew/sim/model.hpp"

#include "arrays.hpp"
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

sim::LinearisationChoice choice(const std::string& tangent, bool geometric_stiffness,
                                bool statics) {
  return {to_tangent(tangent, "linearise(tangent)"), geometric_stiffness, statics};
}

}  // namespace

void bind_simulation_linearisation(SimulationType& type) {
  type.def_property_readonly(
          "rows", [](const Session& self) { return sim::row_names(self.model()); },
          "list of str: the rows of H and W in the scene's order: actuators by name, effectors as "
          "'tip.x', contacts as 'floor point 3 normal'. Joints have none: they are taken out.")
      .def(
          "linearise",
          [](Session& self, const std::string& tangent, bool geometric_stiffness, bool statics) {
            return self.linearise(choice(tangent, geometric_stiffness, statics));
          },
          py::kw_only(), py::arg("tangent") = "exact", py::arg("geometric_stiffness") = true,
          py::arg("statics") = true,
          R"(linearise($self, *, tangent='exact', geometric_stiffness=True, statics=True)
--

How motions follow from efforts near the present state, which is not changed.

Parameters
----------
tangent : {'exact', 'projected', 'rotated'}
    The elements' stiffness: the derivative of the forces, the same made positive semi-definite
    element by element, or R K0 R^T with rotations held fixed.
geometric_stiffness : bool
    Whether loaded cables add theirs.
statics : bool
    W of equilibrium, H K^-1 H^T; False: of the scene's integrator and time step.

Returns
-------
Linearisation
    `W`, `delta`, `delta_free`, `effort`, `rows`, `residual`, `negative_pivots`.

Raises
------
RunError
    singular-matrix.
)")
      .def(
          "compliance",
          [](Session& self, const std::string& tangent, bool geometric_stiffness, bool statics) {
            return copy(self.linearise(choice(tangent, geometric_stiffness, statics)).compliance);
          },
          py::kw_only(), py::arg("tangent") = "exact", py::arg("geometric_stiffness") = true,
          py::arg("statics") = true,
          R"(compliance($self, *, tangent='exact', geometric_stiffness=True, statics=True)
--

W of linearise(): (rows, rows) ndarray, m/N, rows and columns as `rows`.
)");
}

}  // namespace sinew::python
