// Binds the linearised response of motions to efforts.
#include <string>

#include "sinew/model/model.hpp"

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
          "'tip.x', contacts as 'floor point 3 normal'. Joints have no rows here: they are "
          "eliminated.")
      .def(
          "linearise",
          [](Session& self, const std::string& tangent, bool geometric_stiffness, bool statics,
             bool fields) {
            auto asked = choice(tangent, geometric_stiffness, statics);
            asked.fields = fields;
            return self.linearise(asked);
          },
          py::kw_only(), py::arg("tangent") = "exact", py::arg("geometric_stiffness") = true,
          py::arg("statics") = true, py::arg("fields") = false,
          R"(linearise($self, *, tangent='exact', geometric_stiffness=True, statics=True, fields=False)
--

Linearises the motions of the rows with respect to their efforts near the present state, which is not changed.

Contacts have rows for the points with which a step from here would begin: those with a force or near
a surface. Points that share a row (`aggregate`) have the name of one of them and the sum
of their efforts.

Parameters
----------
tangent : {'exact', 'projected', 'corotated'}
    Stiffness of the elements: the derivative of the forces; its projection that is positive semi-definite
    element by element; or R K0 R^T with rotations held fixed.
geometric_stiffness : bool
    Whether to add the geometric stiffness of loaded cables.
statics : bool
    True: W of equilibrium, H K^-1 H^T; False: W of the scene's integrator and time step.
fields : bool
    Whether to compute the motions of all nodes, K^-1 H^T, with the same factorisation: the
    compliance between the rows and forces at any point of a body, see Linearisation.fields.

Returns
-------
Linearisation
    `W`, `delta`, `delta_free`, `effort`, `rows`, `residual`, `negative_pivots`, `fields`.

Raises
------
RunError
    singular-matrix.
)")
      .def(
          "last_linearisation", [](Session& self) { return self.last_linearisation(); },
          R"(last_linearisation($self)
--

W and delta_free of the last step, without a factorisation: for filters and fast loops.

They belong to the last linearisation of the last substep, with the scene's integrator and time step; after
solve_static() to that of the equilibrium. `delta` and `effort` are the present ones, `residual` is NaN and
there are no fields. linearise(), compliance() and response() do not change it. It is not part of the
state.

Returns
-------
Linearisation

Raises
------
Error
    bad-argument if no step or solution led to the present state: before the first one, after
    restore(), load_state(), reset() and a failed step, and after an event-driven step that
    ended with an impact or a check for impacts. Use linearise() there.
)")
      .def(
          "compliance",
          [](Session& self, const std::string& tangent, bool geometric_stiffness, bool statics) {
            auto asked = choice(tangent, geometric_stiffness, statics);
            asked.every_point = true;
            return copy(self.linearise(asked).compliance);
          },
          py::kw_only(), py::arg("tangent") = "exact", py::arg("geometric_stiffness") = true,
          py::arg("statics") = true,
          R"(compliance($self, *, tangent='exact', geometric_stiffness=True, statics=True)
--

W as in linearise(), but with every contact point: (rows, rows) ndarray, m/N, rows and columns
as `rows`. For surfaces whose contact points are searched in every step, the last ones found have rows.
)");
}

}  // namespace sinew::python
