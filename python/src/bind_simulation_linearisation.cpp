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

How motions follow from efforts near the present state, which is not changed.

Of contacts, the points that a step from here would begin with have rows: those with a force or near
what they may touch. Points that share a row (`aggregate`) have the name of one of them and the sum
of their efforts.

Parameters
----------
tangent : {'exact', 'projected', 'corotated'}
    The elements' stiffness: the derivative of the forces, the same made positive semi-definite
    element by element, or R K0 R^T with rotations held fixed.
geometric_stiffness : bool
    Whether loaded cables add theirs.
statics : bool
    W of equilibrium, H K^-1 H^T; False: of the scene's integrator and time step.
fields : bool
    Whether the motions of all nodes are computed too, K^-1 H^T, with the same factorisation: the
    compliance between the rows and forces at any place on a body, see Linearisation.fields.

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

W and delta_free as the last step had them, without a factorisation: for filters and fast loops.

Those of the last substep's last linearisation, of the scene's integrator and time step; after
solve_static() those of the equilibrium. `delta` and `effort` are those of now, `residual` is NaN and
there are no fields. linearise(), compliance() and response() leave it as it was. It is no part of the
state.

Returns
-------
Linearisation

Raises
------
Error
    bad-argument where no step or solve led to the present state: before the first one, after
    restore(), load_state(), reset() and a step that failed, and after an event-driven step that
    ended with an impact or a look at contacts that strike. linearise() works there.
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

W as linearise() has it, but with every contact point: (rows, rows) ndarray, m/N, rows and columns
as `rows`. Of surfaces that are searched for points in every step, those found last have rows.
)");
}

}  // namespace sinew::python
