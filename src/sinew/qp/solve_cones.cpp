#include "sinew/qp/solve_cones.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/qp/sparse_cone_problem.hpp"

namespace sinew::qp {

namespace {

void check(Eigen::Index rows, Eigen::Index columns, const VectorX& q,
           std::span<const double> friction, double tolerance, std::span<const double> start) {
  const auto size = static_cast<Eigen::Index>(3 * friction.size());
  const bool fits = rows == size && columns == size && q.size() == size &&
                    (start.empty() || static_cast<Eigen::Index>(start.size()) == size);
  if (!fits) {
    throw Error(ErrorKind::wrong_shape, {.item = "solve_cones"},
                fmt::format("W ({}, {}), q ({},), friction ({},) and start ({},) do not fit", rows,
                            columns, q.size(), friction.size(), start.size()),
                "give n coefficients of friction, W (3n, 3n), q (3n,), and start (3n,) or none");
  }
  for (std::size_t k = 0; k < friction.size(); ++k) {
    if (friction[k] >= 0.0 && std::isfinite(friction[k])) continue;
    throw Error(ErrorKind::out_of_range, {.item = fmt::format("friction[{}]", k)},
                fmt::format("{} is not a coefficient of friction", friction[k]), "give one >= 0");
  }
  if (tolerance > 0.0) return;
  throw Error(ErrorKind::out_of_range, {.item = "tolerance"},
              fmt::format("{} is not above 0", tolerance), "give a positive one, as 1e-8");
}

// Relative asymmetry of a matrix; 0 if the matrix is zero or not finite.
double asymmetry_of(double difference, double largest) {
  return largest > 0.0 ? difference / largest : 0.0;
}

template <class Problem, class Matrix>
ConeSolution solve_symmetric(const Matrix& matrix, const VectorX& q,
                             std::span<const double> friction, double tolerance,
                             std::span<const double> start) {
  std::vector<ConeBlock> cones;
  for (std::size_t k = 0; k < friction.size(); ++k) {
    cones.push_back({3 * static_cast<int>(k), friction[k]});
  }
  ConeSolution solution;
  solution.x = VectorX::Zero(q.size());
  std::ranges::copy(start, solution.x.begin());
  ConeSolver solver({.tolerance = tolerance, .measure = ConeMeasure::natural_map});
  const ConeResult& result =
      solver.solve(Problem{matrix, q, {}, cones},
                   {solution.x.data(), static_cast<std::size_t>(solution.x.size())});
  solution.status = result.status;
  solution.residual = result.residual;
  solution.iterations = result.sweeps + result.newton_steps;
  solution.states = result.states;
  return solution;
}

}  // namespace

ConeSolution solve_cones(const Eigen::SparseMatrix<double>& w, const VectorX& q,
                         std::span<const double> friction, double tolerance,
                         std::span<const double> start) {
  check(w.rows(), w.cols(), q, friction, tolerance, start);
  const Eigen::SparseMatrix<double> turned = w.transpose();
  Eigen::SparseMatrix<double> symmetric = 0.5 * (w + turned);
  symmetric.makeCompressed();
  ConeSolution solution =
      solve_symmetric<SparseConeProblem>(symmetric, q, friction, tolerance, start);
  const Eigen::SparseMatrix<double> difference = w - turned;
  double off = 0.0, largest = 0.0;
  for (Eigen::Index j = 0; j < w.cols(); ++j) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(difference, j); it; ++it) {
      off = std::max(off, std::abs(it.value()));
    }
    for (Eigen::SparseMatrix<double>::InnerIterator it(w, j); it; ++it) {
      largest = std::max(largest, std::abs(it.value()));
    }
  }
  solution.asymmetry = asymmetry_of(off, largest);
  return solution;
}

ConeSolution solve_cones(const Eigen::Ref<const MatrixX>& w, const VectorX& q,
                         std::span<const double> friction, double tolerance,
                         std::span<const double> start) {
  check(w.rows(), w.cols(), q, friction, tolerance, start);
  const MatrixX symmetric = 0.5 * (w + w.transpose());
  ConeSolution solution = solve_symmetric<ConeProblem>(symmetric, q, friction, tolerance, start);
  if (w.size() > 0) {
    solution.asymmetry =
        asymmetry_of((w - w.transpose()).cwiseAbs().maxCoeff(), w.cwiseAbs().maxCoeff());
  }
  return solution;
}

}  // namespace sinew::qp
