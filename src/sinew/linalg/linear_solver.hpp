/// @file
/// The least that a body asks of its solver of linear equations, for solvers that are not built in:
/// iterative ones, or those of other libraries.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "sinew/core/thread_pool.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/factor_status.hpp"

namespace sinew::linalg {

struct FactorisationSettings;

/// Solves A x = b with a symmetric A of 3x3 blocks. What Factorisation adds - W, the free motion,
/// rows that come and go - is computed from solutions (SolvedRows).
///
/// A result must depend on the calls alone, bit for bit: neither on the number of threads nor on
/// when something ends. A preconditioner that is made beside the run is taken over at a number of
/// calls of prepare(), not when it is ready. It is part of what a saved state must restore; a
/// solver without memory of earlier matrices has nothing to restore.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Takes A. @param matrix layout of BlockPattern; not used after the call.
  /// @return what the solver can tell: `indefinite` if it met a negative pivot or a direction of
  ///   negative curvature, `singular` if it cannot solve.
  virtual FactorStatus prepare(std::span<const double> matrix) = 0;
  /// Solves x = A^-1 right for `count` contiguous right-hand sides (3 n,). x may be right. A solver
  /// that does not reach its accuracy writes NaN, which fails the step.
  virtual void solve(std::span<const double> right, std::span<double> x, int count = 1) = 0;
  /// Number of negative eigenvalues of A, if the solver counts them. Steps work without it, by the
  /// projected tangent; searches for equilibria need it.
  virtual std::optional<int> negative_pivots() const { return {}; }
  /// Releases the memory of the factor until the next prepare().
  virtual void release() {}
  virtual std::size_t bytes() const = 0;
};

/// A kind of solver, by name.
struct SolverBackend {
  std::string name;         ///< in scenes: `solver: {factorisation: NAME}`
  std::string description;  ///< in the reference of scenes: "Conjugate gradients."
  /// Makes a solver for matrices of a pattern. @param pool outlives it.
  std::function<std::unique_ptr<LinearSolver>(
      const BlockPattern& pattern, const FactorisationSettings& settings, ThreadPool& pool)>
      make;
};

/// Adds a solver from outside the library; bodies then choose it by its name. Call it before scenes
/// are read, from one thread. Throws Error: duplicate-key (the name is taken), bad-argument (no
/// name or function; scenes were read before).
void register_backend(SolverBackend backend);

}  // namespace sinew::linalg
