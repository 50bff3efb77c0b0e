// Binds the solver of convex quadratic programs.
#include <limits>
#include <string>

#include "sinew/core/error.hpp"
#include "sinew/qp/quadratic_program.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using qp::QpResult;

// Converts limits (n,), which may be infinite; None becomes `missing` everywhere.
VectorX to_limits(const py::object& value, const std::string& place, Eigen::Index size,
                  double missing) {
  if (value.is_none()) return VectorX::Constant(size, missing);
  const MatrixX limits = to_gappy_matrix(value, place, "(n,), infinite for no limit");
  if (limits.size() == size && limits.cols() == 1 && !limits.hasNaN()) return limits;
  throw Error(ErrorKind::wrong_shape, {.item = place},
              "it is not a vector of " + std::to_string(size) + " numbers",
              "give one limit for each, infinite where there is none");
}

QpResult solve_quadratic(const py::object& hessian, const py::object& gradient,
                         const py::object& lower, const py::object& upper, const py::object& rows,
                         const py::object& row_lower, const py::object& row_upper) {
  const auto place = [](const char* name) { return "solve_quadratic(" + std::string(name) + ")"; };
  qp::QuadraticProgram program;
  program.hessian = to_matrix(hessian, place("G"), "(n, n)");
  const Eigen::Index n = program.hessian.rows();
  program.gradient = to_vector(gradient, place("g"), n, "");
  program.lower = to_limits(lower, place("lower"), n, -kInfinity);
  program.upper = to_limits(upper, place("upper"), n, kInfinity);
  program.rows = rows.is_none() ? MatrixX(0, n) : to_matrix(rows, place("C"), "(m, n)");
  const Eigen::Index m = program.rows.rows();
  program.row_lower = to_limits(row_lower, place("row_lower"), m, -kInfinity);
  program.row_upper = to_limits(row_upper, place("row_upper"), m, kInfinity);
  const py::gil_scoped_release others;
  return qp::QpSolver(static_cast<int>(n), static_cast<int>(m)).solve(program);
}

constexpr const char* kSolveDoc =
    R"(solve_quadratic(G, g, lower=None, upper=None, C=None, row_lower=None, row_upper=None)
--

Solves a convex quadratic program,

    min 1/2 x^T G x + g^T x   with   lower <= x <= upper,   row_lower <= C x <= row_upper,

by the dual active-set method of Goldfarb and Idnani (Math. Programming 27 (1983) 1-33). Equal limits
make an equation.

Parameters
----------
G : (n, n) array_like
    Symmetric and positive semidefinite; only the lower triangle is read.
g : (n,) array_like
lower, upper : (n,) array_like, optional
    Infinite for no limit.
C : (m, n) array_like, optional
row_lower, row_upper : (m,) array_like, optional

Returns
-------
QuadraticSolution
    Its status tells whether the problem was solved.

Raises
------
Error
    wrong-type, wrong-shape, not-finite; contradictory-limits: a lower limit above its upper one.)";

}  // namespace

void bind_quadratic(py::module_& module) {
  py::class_<QpResult>(module, "QuadraticSolution", "Result of solve_quadratic().")
      .def_property_readonly(
          "x", [](const QpResult& self) { return reading(self.x); }, "(n,) solution.")
      .def_property_readonly(
          "status",
          [](const QpResult& self) { return std::string(qp::qp_status_name(self.status)); },
          "'optimal', 'infeasible', 'unbounded', 'not-convex', 'iteration-limit' or 'not-finite'.")
      .def_property_readonly(
          "bound_multiplier", [](const QpResult& self) { return reading(self.bound_multiplier); },
          "(n,) multipliers y of G x + g = y + C^T z: positive at a lower limit, negative at an "
          "upper one.")
      .def_property_readonly(
          "row_multiplier", [](const QpResult& self) { return reading(self.row_multiplier); },
          "(m,) z, likewise.")
      .def_readonly("iterations", &QpResult::iterations, "int: changes of the active set.");
  module.def("solve_quadratic", solve_quadratic, py::arg("G"), py::arg("g"),
             py::arg("lower") = py::none(), py::arg("upper") = py::none(),
             py::arg("C") = py::none(), py::arg("row_lower") = py::none(),
             py::arg("row_upper") = py::none(), kSolveDoc);
}

}  // namespace sinew::python
