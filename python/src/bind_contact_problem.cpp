// Binds contact problems of a step, and their files.
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "sinew/law/contact_problem.hpp"
#include "sinew/record/fclib.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

/// A problem u = W r + q in Python. W is dense, or sparse of scipy; r is None without a solution.
struct ContactProblem {
  py::object w;
  Array q, friction;
  py::object r;
};

Array copy_list(const std::vector<double>& list) {
  return Array(static_cast<py::ssize_t>(list.size()), list.data());
}

py::object by_columns(const Eigen::SparseMatrix<double>& matrix) {
  const auto entries = static_cast<py::ssize_t>(matrix.nonZeros());
  const auto columns = static_cast<py::ssize_t>(matrix.cols());
  const py::tuple parts = py::make_tuple(Array(entries, matrix.valuePtr()),
                                         py::array_t<int>(entries, matrix.innerIndexPtr()),
                                         py::array_t<int>(columns + 1, matrix.outerIndexPtr()));
  return py::module_::import("scipy.sparse")
      .attr("csc_matrix")(parts, py::arg("shape") = py::make_tuple(columns, columns));
}

// Problems with fewer points are dense. Above, W is sparse up to this density.
constexpr Eigen::Index kFewPoints = 32;
constexpr double kSparse = 0.25;

bool stands_as_sparse(const Eigen::SparseMatrix<double>& matrix) {
  const auto size = static_cast<double>(matrix.rows());
  return matrix.rows() > 3 * kFewPoints &&
         static_cast<double>(matrix.nonZeros()) <= kSparse * size * size;
}

ContactProblem problem_of(const Session& session, const std::optional<bool>& sparse) {
  const Session::Use use(session);
  const law::ContactProblem problem = session.simulation().contacts().problem();
  const bool by_blocks = sparse.value_or(stands_as_sparse(problem.compliance));
  return {
      by_blocks ? by_columns(problem.compliance) : py::object(copy(MatrixX(problem.compliance))),
      copy(problem.motion), copy_list(problem.friction), copy(problem.effort)};
}

ContactProblem read_fclib(const std::filesystem::path& path) {
  record::FclibProblem problem;
  {
    const py::gil_scoped_release others;
    problem = record::read_fclib(path);
  }
  const bool solved = problem.r.size() > 0;
  return {by_columns(problem.w), copy(problem.q), copy_list(problem.friction),
          solved ? py::object(copy(problem.r)) : py::none()};
}

void write_fclib(const std::filesystem::path& path, const py::object& w, const py::object& q,
                 const py::object& friction, const py::object& r, const std::string& title,
                 const std::string& description) {
  const auto vector = [](const py::object& value, const char* place) {
    const std::vector<double> list = to_list(value, place, "");
    return VectorX(Eigen::Map<const VectorX>(list.data(), static_cast<Eigen::Index>(list.size())));
  };
  record::FclibProblem problem;
  problem.w =
      py::hasattr(w, "tocsc")
          ? to_sparse(w)
          : Eigen::SparseMatrix<double>(to_matrix(w, "write_fclib(W)", "(3n, 3n)").sparseView());
  problem.q = vector(q, "write_fclib(q)");
  problem.friction = to_list(friction, "write_fclib(friction)", "");
  if (!r.is_none()) problem.r = vector(r, "write_fclib(r)");
  problem.title = title;
  problem.description = description;
  const py::gil_scoped_release others;
  record::write_fclib(path, problem);
}

void bind_files(py::module_& module) {
  module.def("read_fclib", read_fclib, py::arg("path"), R"(read_fclib(path)
--

Reads a contact problem of the FCLIB collection (HDF5, group fclib_local; W by columns, rows or
triplets). Needs scipy.

Parameters
----------
path : path-like

Returns
-------
ContactProblem
    W is a scipy.sparse.csc_matrix; r is None if the file has no solution.

Raises
------
Error
    file-not-found, unknown-format, malformed-file; not-in-this-version for two-dimensional and global
    problems, and for problems with joint equations.
)");
  module.def("write_fclib", write_fclib, py::arg("path"), py::arg("W"), py::arg("q"),
             py::arg("friction"), py::arg("r") = py::none(), py::arg("title") = "",
             py::arg("description") = "",
             R"(write_fclib(path, W, q, friction, r=None, title='', description='')
--

Writes a contact problem in FCLIB's format, for other solvers: u = W r + q, see solve_cones().

Parameters
----------
path : path-like
    An existing file is replaced.
W : (3n, 3n) array_like, or a sparse matrix of scipy
    Rows of a contact: normal, two tangents.
q : (3n,) array_like
friction : (n,) array_like
r : (3n,) array_like, optional
    A solution; u is written with it.
title, description : str

Raises
------
Error
    wrong-shape, not-finite, file-unwritable, recording-failed.
)");
}

}  // namespace

void bind_contact_problem(py::module_& module, SimulationType& type) {
  py::class_<ContactProblem>(
      module, "ContactProblem",
      "A contact problem: u = W r + q with Signorini's and Coulomb's laws. From "
      "Simulation.contact_problem() (u in m, r in N) or read_fclib().")
      .def_readonly(
          "W", &ContactProblem::w,
          "(3n, 3n) ndarray or sparse matrix; rows of each contact: the normal, two tangents.")
      .def_readonly("q", &ContactProblem::q, "(3n,) ndarray: u without efforts.")
      .def_readonly("friction", &ContactProblem::friction, "(n,) ndarray: mu of each contact.")
      .def_readonly("r", &ContactProblem::r, "(3n,) ndarray: a solution, or None.");
  type.def("contact_problem", problem_of, py::arg("sparse") = py::none(),
           R"(contact_problem($self, sparse=None)
--

The contact problem of the last step or equilibrium: its contact forces are the solution.

The n contacts are the points that took part, in the order of contacts and their points. W and q are
those of the last linearisation of the last substep. Everything else keeps its state in the step:
held motions (joints, cables at a commanded length) stay held, efforts at their limits are constant,
gas is linearised. The problem is not part of the state: it is empty before the first step.

Parameters
----------
sparse : bool, optional
    Whether W is a scipy.sparse.csc_matrix (needs scipy) or an ndarray. By default it is sparse if there
    are more than 32 points and three quarters of W are zero, as with many rigid bodies.

Returns
-------
sinew.qp.ContactProblem
    W (m/N), q: gaps (m, negative inside) and slip of the step (m) without contact forces, r: the
    step's forces (N). sinew.qp.solve_cones() solves it, sinew.qp.write_fclib() writes it.
)");
  bind_files(module);
}

}  // namespace sinew::python
