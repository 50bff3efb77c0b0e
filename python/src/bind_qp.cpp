// Binds the solver of frictional contact problems.
#include <optional>
#include <string>
#include <vector>

#include "sinew/qp/solve_cones.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using qp::ConeSolution;

ConeSolution solve_cones(const py::object& w, const py::object& q, const py::object& friction,
                         const py::object& tolerance, const py::object& start) {
  const double tol = to_number(tolerance, "solve_cones(tolerance)", "");
  const std::vector<double> mu = to_list(friction, "solve_cones(friction)", "");
  const std::vector<double> offset = to_list(q, "solve_cones(q)", "");
  std::vector<double> from;
  if (!start.is_none()) from = to_list(start, "solve_cones(start)", "");
  const Eigen::Map<const VectorX> given(offset.data(), static_cast<Eigen::Index>(offset.size()));
  if (py::hasattr(w, "tocsc")) {
    const Eigen::SparseMatrix<double> sparse = to_sparse(w);
    const py::gil_scoped_release others;
    return qp::solve_cones(sparse, given, mu, tol, from);
  }
  const MatrixX dense = to_matrix(w, "solve_cones(W)", "(3n, 3n)");
  const py::gil_scoped_release others;
  return qp::solve_cones(dense, given, mu, tol, from);
}

std::vector<std::string> state_names(const ConeSolution& self) {
  std::vector<std::string> names;
  for (const qp::ContactState state : self.states) names.emplace_back(contact_state_name(state));
  return names;
}

}  // namespace

void bind_qp(py::module_& module) {
  py::class_<ConeSolution>(module, "ConeSolution", "Result of solve_cones().")
      .def_property_readonly(
          "x", [](const ConeSolution& self) { return reading(self.x); },
          "(3n,) efforts: normal and two tangents of each contact.")
      .def_property_readonly(
          "status",
          [](const ConeSolution& self) { return std::string(cone_status_name(self.status)); },
          "'solved', 'iteration-limit', 'not-finite' or 'not-convex'.")
      .def_readonly("residual", &ConeSolution::residual,
                    "|r - P_K(r - v)|/|q|, v = (u_n + mu |u_t|, u_t), norms over all contacts.")
      .def_readonly("iterations", &ConeSolution::iterations,
                    "Gauss-Seidel sweeps and Newton steps of the group of bodies that took most.")
      .def_readonly("asymmetry", &ConeSolution::asymmetry,
                    "Largest entry of W - W^T relative to the largest entry of W.")
      .def_property_readonly("states", state_names,
                             "State of each contact: 'open', 'stick' or 'slip'.");
  module.def("solve_cones", solve_cones, py::arg("W"), py::arg("q"), py::arg("friction"),
             py::arg("tolerance") = 1e-8, py::arg("start") = py::none(),
             R"(solve_cones(W, q, friction, tolerance=1e-8, start=None)
--

Solves a contact problem with Coulomb friction: u = W r + q with

    0 <= u_n _|_ r_n >= 0,   |r_t| <= mu r_n,   r_t = -mu r_n u_t/|u_t| where u_t != 0.

Parameters
----------
W : (3n, 3n) array_like, or a sparse matrix of scipy
    Positive semidefinite; the symmetric part is used. Rows of a contact: normal, two tangents.
q : (3n,) array_like
    Motions without efforts.
friction : (n,) array_like
    mu >= 0 of each contact.
tolerance : float
    On the natural map, see ConeSolution.residual.
start : (3n,) array_like, optional
    Initial guess of the efforts.

Returns
-------
ConeSolution
    Its status tells whether the problem was solved.)");
}

}  // namespace sinew::python
