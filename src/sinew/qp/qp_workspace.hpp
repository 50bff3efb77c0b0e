/// @file
/// The dual active-set method: working set, iterate and steps.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "sinew/qp/active_set_factors.hpp"
#include "sinew/qp/constraint_rows.hpp"
#include "sinew/qp/quadratic_program.hpp"
#include "sinew/qp/semidefinite_solver.hpp"

namespace sinew::qp {

/// A constraint that presently holds as an equality.
struct ActiveConstraint {
  int constraint = 0;
  int side = 0;  ///< +1 at the lower limit, -1 at the upper one, 0 for an equality (any sign)
  bool violates(double multiplier) const { return side * multiplier < 0.0; }
};

/// The dual active-set method. Between its steps, the state is always a "solution pair": x
/// minimises the objective over the active constraints taken as equalities, and all their
/// multipliers have the right sign. A step adds the most violated constraint and restores a pair
/// with a larger objective, so no active set occurs twice. A warm start makes a pair from the last
/// active set: it leaves out constraints that have become dependent and drops those with a
/// multiplier of the wrong sign. In the worst case none is left and the start is cold.
/// Source: Goldfarb and Idnani, Math. Programming 27 (1983) 1-33, sections 3 and 4.
struct QpSolver::Workspace {
  Workspace(int variables, int constraints, QpSettings chosen);

  void solve(const QuadraticProgram& problem);
  void reset() { active.clear(); }

  int variables;
  QpSettings settings;
  QpResult result;

 private:
  /// Outcome of adding a constraint.
  enum class Addition { added, redundant, infeasible, out_of_iterations };

  QpStatus load_and_factorise(const QuadraticProgram& problem);
  QpStatus run(const QuadraticProgram& problem);
  void start_from_last_set();
  /// Makes a solution pair from the active set, dropping constraints whose multiplier has the wrong
  /// sign; then refines it.
  void settle(const QuadraticProgram& problem, bool refine);
  void solve_subproblem();
  void refine_subproblem(const QuadraticProgram& problem);
  bool drop_worst_multiplier();
  int violated_side(int c, double* violation) const;
  int most_violated(int* side) const;
  Addition add_constraint(int c, int side);
  int blocking_multiplier(int c, int side, double* step) const;
  bool is_contradiction(int c, int side);
  void project(int c);
  void activate(int c, int side, double multiplier);
  void deactivate(int position);
  double active_limit(const ActiveConstraint& entry) const;
  void measure_iterate();
  void solve_semidefinite(const QuadraticProgram& problem);
  void write_result(QpStatus status);

  ConstraintRows constraints;
  ActiveSetFactors factors;
  std::vector<ActiveConstraint> active;
  std::vector<ActiveConstraint> last_set;  ///< (n) the active set from which a warm start begins
  std::vector<std::uint8_t> state;  ///< per constraint: 0 idle, 1 active, 2 met within rounding
  VectorX x;                        ///< (stride)
  VectorX gradient;                 ///< (stride) g, padded
  VectorX multipliers;              ///< (stride) of the active constraints, in their order
  VectorX values;                   ///< (stride) limits of the active constraints
  VectorX residual, correction, multiplier_correction;
  std::unique_ptr<SemidefiniteSolver> semidefinite;  ///< created for the first singular Hessian
  double objective_size = 0.0;                       ///< |L^-1 g|
  double iterate_size = 0.0;  ///< |L^-1 g| + max |x_i| sqrt(G_ii), to which rounding is relative
  int iterations = 0;
  int iteration_limit = 0;
};

}  // namespace sinew::qp
