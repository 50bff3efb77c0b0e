/// @file
/// Dense convex quadratic programs, solved by a dual active-set method. Independent of physics.
#pragma once

#include <memory>
#include <string_view>

#include "sinew/core/types.hpp"

namespace sinew::qp {

/// A convex quadratic program: min 1/2 x^T G x + g^T x   s.t.   lower <= x <= upper,
/// row_lower <= C x <= row_upper.
/// Infinite limits are allowed; equal limits make an equality. G is (n, n), symmetric positive
/// semidefinite (only its lower triangle is read); C is (m, n).
struct QuadraticProgram {
  MatrixX hessian;
  VectorX gradient;
  VectorX lower, upper;
  MatrixX rows;
  VectorX row_lower, row_upper;

  /// A program of this size: hessian, gradient and rows zero, every limit infinite.
  static QuadraticProgram sized(int variables, int constraints);
};

/// How a solve ended.
enum class QpStatus {
  optimal,
  infeasible,       ///< no x meets all limits
  unbounded,        ///< the objective decreases without bound along result.ray
  not_convex,       ///< G has a negative eigenvalue, beyond working precision
  iteration_limit,  ///< settings.max_iterations reached; x is the last iterate
  not_finite,       ///< NaN or infinity in the problem's data
};
/// The status as it is printed: "iteration-limit".
std::string_view qp_status_name(QpStatus status);

/// How QpSolver works.
struct QpSettings {
  double tolerance = 1e-11;  ///< feasibility, relative to the size of limits and of C x
  int max_iterations = 0;    ///< 0: 10 (n + m) + 100
  bool warm_start = true;    ///< start from the active set of the last solve
};

/// Solution and multipliers. G x + g = y + C^T z with y, z > 0 at a lower limit, < 0 at an upper
/// one.
struct QpResult {
  QpStatus status = QpStatus::optimal;
  VectorX x;                 ///< (n,)
  VectorX bound_multiplier;  ///< (n,) y
  VectorX row_multiplier;    ///< (m,) z
  int iterations = 0;
  int active = 0;  ///< active limits at the solution
  VectorX ray;     ///< (n,) of an unbounded problem: a feasible ray, largest |entry| 1
};

/// Solver of quadratic programs of one size. It owns the workspace and the last active set. solve()
/// allocates nothing, except for the first problem with a singular Hessian. Such a problem may have
/// many solutions: the solver returns the one with the least sum of G_ii x_i^2 (of x_i^2 where
/// G_ii = 0), see SemidefiniteSolver.
class QpSolver {
 public:
  QpSolver();
  QpSolver(int variables, int constraints, QpSettings settings = {});
  ~QpSolver();
  QpSolver(QpSolver&&) noexcept;
  QpSolver& operator=(QpSolver&&) noexcept;

  /// Throws Error: wrong-shape if the problem is not of the solver's size, contradictory-limits if
  /// a lower limit exceeds its upper one.
  const QpResult& solve(const QuadraticProgram& problem);
  /// Forgets the active set of the last solve.
  void reset();

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

/// Largest violation of the KKT conditions, each scaled to be relative: stationarity, feasibility,
/// sign of multipliers, complementarity. Independent of the solver; for tests.
double kkt_residual(const QuadraticProgram& problem, const QpResult& result);

}  // namespace sinew::qp
