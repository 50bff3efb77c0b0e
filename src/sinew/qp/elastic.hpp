/// @file
/// Quadratic programs whose rows may conflict: bounds hold exactly, rows as far as possible.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "sinew/qp/quadratic_program.hpp"

namespace sinew::qp {

/// How to measure the violation of rows that cannot all be met.
enum class ElasticMeasure {
  worst,  ///< minimises the largest weighted violation, then the next largest, and so on
  sum,    ///< minimises the sum of weighted violations; usually relaxes few rows
};

/// How an elastic solve ended.
enum class ElasticStatus {
  optimal,          ///< every row is met
  relaxed,          ///< rows conflict; result.violation says which are relaxed and by how much
  unbounded,        ///< as in QpStatus, within the bounds and the relaxed rows
  not_convex,       ///< as in QpStatus
  not_finite,       ///< as in QpStatus
  iteration_limit,  ///< x meets the bounds but may not be optimal
};
/// The status as it is printed: "iteration-limit".
std::string_view elastic_status_name(ElasticStatus status);

/// How ElasticSolver works.
struct ElasticSettings {
  ElasticMeasure measure = ElasticMeasure::worst;
  QpSettings qp;  ///< of the quadratic programs that are solved
  double tolerance =
      1e-8;  ///< smaller violations, relative to the largest, count as zero; 1e-12..1e-4
  int max_proximal_steps = 60;  ///< per stage; a handful usually suffices
};

/// What ElasticSolver found.
struct ElasticResult {
  ElasticStatus status = ElasticStatus::optimal;
  QpResult qp;  ///< x and multipliers of the problem with relaxed limits
  VectorX
      violation;  ///< (m,) C x minus the limit it exceeds: > 0 above the upper, < 0 below the lower
  int relaxed = 0;   ///< number of rows with a violation
  int programs = 0;  ///< quadratic programs solved
};

/// Solver of quadratic programs with rows that may conflict. Over lower <= x <= upper, it first
/// minimises the violations of the rows in the chosen measure, and then the objective among the
/// points that minimise them (lexicographically: no penalty weight trades one for the other).
///
/// If all rows can be met, this is one QpSolver::solve. Otherwise the smallest violation, a linear
/// program, is found by proximal steps, which reach an exact solution after finitely many steps
/// (Rockafellar, SIAM J. Control Optim. 14 (1976) 877-898, proposition 8). Its multipliers identify
/// the conflicting rows. The limits of these rows are moved by just as much as needed, and the
/// objective is minimised with the moved limits. For `worst`, the worst violation of the other rows
/// is then minimised in turn, and so on, so that a conflict of two rows relaxes no third one.
class ElasticSolver {
 public:
  ElasticSolver(int variables, int constraints, ElasticSettings settings = {});
  ~ElasticSolver();
  ElasticSolver(ElasticSolver&&) noexcept;
  ElasticSolver& operator=(ElasticSolver&&) noexcept;

  /// Solves a problem of the solver's size, with unit weights. Allocates as QpSolver::solve does.
  /// Throws as QpSolver::solve.
  const ElasticResult& solve(const QuadraticProgram& problem);
  /// The same with weights, which make violations in different units comparable. `row_weight` (m,)
  /// is > 0 and finite, in 1/(unit of the row): a violation of 1/weight counts as 1. Throws Error:
  /// wrong-shape, out-of-range otherwise.
  const ElasticResult& solve(const QuadraticProgram& problem, const VectorX& row_weight);
  /// Forgets the active sets of the last solve.
  void reset();

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

/// Solves one problem with a new ElasticSolver. Throws as ElasticSolver::solve.
ElasticResult solve_elastic(const QuadraticProgram& problem, const ElasticSettings& settings = {});

}  // namespace sinew::qp
