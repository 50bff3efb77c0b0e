/// @file
/// Smooth sparse nonlinear programs, min f(x) with bounds on x and on c(x), and their solution by
/// an interior-point method, from far by Ipopt with its filter line search (Waechter & Biegler,
/// Mathematical Programming 106, 2006). Knows no physics.
#pragma once

#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/frontal_factorisation.hpp"

namespace sinew::plan {

/// Beyond this a bound is none.
inline constexpr double kNoBound = 1e20;

struct Bounds {
  VectorX lower, upper;  ///< +-kNoBound: none; equal: an equality
};

using linalg::SparseEntry;

/// What the solver asks of a problem. Derivatives are exact.
class NonlinearProgram {
 public:
  NonlinearProgram() = default;
  NonlinearProgram(const NonlinearProgram&) = delete;
  NonlinearProgram& operator=(const NonlinearProgram&) = delete;
  virtual ~NonlinearProgram() = default;

  const Bounds& variable_bounds() const { return variable_bounds_; }
  const Bounds& constraint_bounds() const { return constraint_bounds_; }
  /// Typical magnitudes, > 0, by which the solver scales. (variables,), (constraints,).
  const VectorX& variable_scale() const { return variable_scale_; }
  const VectorX& constraint_scale() const { return constraint_scale_; }
  double objective_scale() const { return objective_scale_; }
  const std::vector<SparseEntry>& jacobian_pattern() const { return jacobian_pattern_; }
  const std::vector<SparseEntry>& hessian_pattern() const { return hessian_pattern_; }  ///< lower

  virtual double objective(const VectorX& x) = 0;
  virtual void gradient(const VectorX& x, VectorX& result) = 0;
  virtual void constraints(const VectorX& x, VectorX& result) = 0;
  /// @param x where. @param values (pattern's entries,).
  virtual void jacobian(const VectorX& x, double* values) = 0;
  /// Of factor f + multipliers . c.
  virtual void hessian(const VectorX& x, double factor, const VectorX& multipliers,
                       double* values) = 0;

 protected:
  // Set by the derived program's constructor.
  Bounds variable_bounds_, constraint_bounds_;
  VectorX variable_scale_, constraint_scale_;
  double objective_scale_ = 1.0;
  std::vector<SparseEntry> jacobian_pattern_, hessian_pattern_;
};

enum class Status {
  solved,           ///< to the tolerance
  acceptable,       ///< to a hundred times the tolerance, no further
  infeasible,       ///< the violation has a local minimum above zero
  iteration_limit,  ///< stopped short
  time_limit,       ///< stopped short
  failed,           ///< the solver lost its way: numbers out of range, no step found
};
/// "solved", "acceptable", "infeasible", "iteration-limit", "time-limit", "failed".
std::string_view status_name(Status status);

struct SolverSettings {
  double tolerance = 1e-6;   ///< of the scaled optimality and violation
  int max_iterations = 300;  ///< >= 1
  double max_time = 30.0;    ///< s of processor time
  bool verbose = false;      ///< the solver's own table on stdout
};

/// A point with its multipliers. Multipliers may be empty: a cold start.
struct ProgramPoint {
  VectorX x;                                     ///< (variables,)
  VectorX constraint_multipliers;                ///< (constraints,)
  VectorX lower_multipliers, upper_multipliers;  ///< (variables,), of the bounds on x, >= 0
};

struct ProgramResult {
  Status status = Status::failed;
  ProgramPoint point;
  double objective = 0.0;
  double violation = 0.0;  ///< largest of c's, unscaled
  int iterations = 0;
  double seconds = 0.0;
};

/// Solves a program: by solve_nearby() where the start has multipliers, and by Ipopt where it has
/// none or that does not converge. Ipopt runs in one thread at a time, callers wait: its linear
/// solver (MUMPS, sequential) keeps global state.
ProgramResult solve(NonlinearProgram& program, const ProgramPoint& start,
                    const SolverSettings& settings = {});

}  // namespace sinew::plan
