/// @file
/// Quadratic programs whose rows may conflict: bounds hold exactly, rows as far as possible.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "sinew/qp/quadratic_program.hpp"

namespace sinew::qp {

/// What "as far as possible" means for rows that cannot all be met.
enum class ElasticMeasure {
  worst,  ///< the largest weighted violation is least, then the next largest, and so on
  sum,    ///< the sum of weighted violations is least; as a rule few rows are relaxed
};

/// How an elastic solve ended.
enum class ElasticStatus {
  optimal,          ///< every row is met
  relaxed,          ///< rows conflict; result.violation says which are relaxed and by how much
  unbounded,        ///< as in QpStatus, within the bounds and the relaxed rows
  not_convex,       ///< as in QpStatus
  not_finite,       ///< as in QpStatus
  iteration_limit,  ///< x keeps the bounds but need not be best
};
/// The status as it is printed: "iteration-limit".
std::string_view elastic_status_name(ElasticStatus status);

/// How ElasticSolver works.
struct ElasticSettings {
  ElasticMeasure measure = ElasticMeasure::worst;
  QpSettings qp;  ///< of the quadratic programs solved on the way
  double tolerance =
      1e-8;  ///< violations below this, relative to the largest, are none; 1e-12..1e-4
  int max_proximal_steps = 60;  ///< per stage; a handful suffices as a rule
};

/// What ElasticSolver found.
struct ElasticResult {
  ElasticStatus status = ElasticStatus::optimal;
  QpResult qp;  ///< x and the multipliers of the problem with the relaxed limits
  VectorX
      violation;  ///< (m,) C x minus the limit it exceeds: > 0 above the upper, < 0 below the lower
  int relaxed = 0;   ///< number of rows with a violation
  int programs = 0;  ///< quadratic programs solved
};

/// Minimises, over lower <= x <= upper, first the violations of the rows in the chosen measure and
/// then the objective among the points that are best in it (lexicographically: no penalty weight
/// trades one for the other).
///
/// When all rows can be met this is one QpSolver::solve. Else the least violation, a linear
/// program, is found by proximal steps, which end at an exact solution after finitely many
/// (Rockafellar, SIAM J. Control Optim. 14 (1976) 877-898, proposition 8). Its multipliers name the
/// rows that stand in each other's way; their limits are moved by just as much as needed, and the
/// objective is minimised with these limits. For `worst`, the rows not in the way then have their
/// own worst violation minimised, and so on, so that a conflict of two rows loosens no third.
class ElasticSolver {
 public:
  ElasticSolver(int variables, int constraints, ElasticSettings settings = {});
  ~ElasticSolver();
  ElasticSolver(ElasticSolver&&) noexcept;
  ElasticSolver& operator=(ElasticSolver&&) noexcept;

  /// Allocates nothing. Throws as QpSolver::solve.
  const ElasticResult& solve(const QuadraticProgram& problem);
  /// The same with weights, which make violations in different units comparable.
  /// `row_weight` (m,) is > 0 and finite, in 1/(unit of the row): a violation of 1/weight counts as
  /// 1. Throws Error(wrong-shape) or Error(out-of-range) otherwise.
  const ElasticResult& solve(const QuadraticProgram& problem, const VectorX& row_weight);
  /// Forgets the active sets of the last solve.
  void reset();

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

/// ElasticSolver made for one problem. Throws as ElasticSolver::solve.
ElasticResult solve_elastic(const QuadraticProgram& problem, const ElasticSettings& settings = {});

}  // namespace sinew::qp
