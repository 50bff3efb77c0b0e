/// @file
/// Smooth sparse nonlinear programs, min f(x) with bounds on x and on c(x), and their solution by
/// interior-point methods. From a distant start, this is Ipopt with its filter line search
/// (Waechter & Biegler, Mathematical Programming 106, 2006). Independent of physics.
#pragma once

#include <string_view>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/frontal_factorisation.hpp"

namespace sinew::plan {

/// Bounds of at least this magnitude are inactive.
inline constexpr double kNoBound = 1e20;

/// Lower and upper bounds.
struct Bounds {
  VectorX lower, upper;  ///< +-kNoBound: none; equal: an equality
};

using linalg::SparseEntry;

/// The interface of a program to the solvers. Derivatives are exact.
class NonlinearProgram {
 public:
  NonlinearProgram() = default;
  NonlinearProgram(const NonlinearProgram&) = delete;
  NonlinearProgram& operator=(const NonlinearProgram&) = delete;
  virtual ~NonlinearProgram() = default;

  const Bounds& variable_bounds() const { return variable_bounds_; }
  const Bounds& constraint_bounds() const { return constraint_bounds_; }
  /// Typical magnitudes by which the solver scales, > 0: (variables,), (constraints,).
  const VectorX& variable_scale() const { return variable_scale_; }
  const VectorX& constraint_scale() const { return constraint_scale_; }
  double objective_scale() const { return objective_scale_; }
  const std::vector<SparseEntry>& jacobian_pattern() const { return jacobian_pattern_; }
  const std::vector<SparseEntry>& hessian_pattern() const { return hessian_pattern_; }  ///< lower

  virtual double objective(const VectorX& x) = 0;
  virtual void gradient(const VectorX& x, VectorX& result) = 0;
  virtual void constraints(const VectorX& x, VectorX& result) = 0;
  /// Entries of the Jacobian of c. @param x (variables,). @param values in the order of the
  /// pattern.
  virtual void jacobian(const VectorX& x, double* values) = 0;
  /// Entries of the Hessian of factor f + multipliers . c, in the order of the pattern.
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
  acceptable,       ///< only to a hundred times the tolerance
  infeasible,       ///< the violation has a local minimum above zero
  iteration_limit,  ///< stopped at the limit
  time_limit,       ///< stopped at the limit
  failed,           ///< the solver failed: numbers out of range, or no step found
};
/// "solved", "acceptable", "infeasible", "iteration-limit", "time-limit", "failed".
std::string_view status_name(Status status);

struct SolverSettings {
  double tolerance = 1e-6;   ///< of the scaled optimality error and violation
  int max_iterations = 300;  ///< >= 1
  double max_time = 30.0;    ///< s of processor time
  bool verbose = false;      ///< whether the solver prints its table to stdout
};

/// A point with its multipliers. Empty multipliers mean a cold start.
struct ProgramPoint {
  VectorX x;                                     ///< (variables,)
  VectorX constraint_multipliers;                ///< (constraints,)
  VectorX lower_multipliers, upper_multipliers;  ///< (variables,), of the bounds on x, >= 0
};

struct ProgramResult {
  Status status = Status::failed;
  ProgramPoint point;
  double objective = 0.0;
  double violation = 0.0;  ///< largest constraint violation, unscaled
  int iterations = 0;
  double seconds = 0.0;
};

/// Solves a program: by solve_nearby() if the start has multipliers, and by Ipopt if it has none or
/// solve_nearby() does not converge. Only one thread runs Ipopt at a time while other callers wait,
/// since its linear solver (MUMPS, sequential) has global state.
ProgramResult solve(NonlinearProgram& program, const ProgramPoint& start,
                    const SolverSettings& settings = {});

}  // namespace sinew::plan
