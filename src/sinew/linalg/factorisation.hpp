/// @file
/// Factorisation of a symmetric matrix A of 3x3 blocks, bordered by constraint rows H. It gives the
/// compliance W = H A^-1 H^T, the free motion H A^-1 b of the rows, and solutions of A x = b. The
/// symbolic phase (FactorisationPlan) is immutable and shared between simulations and threads; the
/// numeric phase (Factorisation) belongs to one simulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/factor_status.hpp"

namespace sinew::linalg {

/// Elimination order. `fastest` tries both orders and keeps the one with the shorter estimated
/// time; if they are close, nested dissection (metis), which gives threads more parallel work. The
/// estimate counts operations and list lengths and reads no clock, so the same pattern gets the
/// same order, and the same bits, on every run and for any number of threads.
enum class Ordering { amd, metis, fastest };

/// Settings of a factorisation.
struct FactorisationSettings {
  std::string backend = "block";  ///< "block" (Sinew's own), or a name of register_backend()
  Ordering ordering = Ordering::fastest;
  int threads = 1;  ///< number of threads of the pool of the numeric phase

  bool operator==(const FactorisationSettings&) const = default;
};

/// Numeric phase, one per simulation. After construction, memory is allocated only by factorise(),
/// if it holds no factor and none was released to the plan, and by condense_transient() for more
/// rows than before.
class Factorisation {
 public:
  virtual ~Factorisation() = default;

  /// Factorises A bordered by H and b.
  /// @param matrix kBlockStride * pattern.blocks() doubles, layout of BlockPattern.
  /// @param border 3 * border.entries() doubles, layout of BorderPattern.
  /// @param right (3 n,) b.
  virtual FactorStatus factorise(std::span<const double> matrix, std::span<const double> border,
                                 std::span<const double> right) = 0;

  /// Releases the memory of the factor to other factorisations of the plan. Results remain valid,
  /// but solving and condensing throw Error(internal) until the next factorise().
  virtual void release() {}

  /// Replaces b, with the same A and H: free_motion(), free_energy() and solve_with_effort() then
  /// refer to the new one; transient_coupling() does not. Costs one forward substitution.
  /// @param right (3 n,) b.
  virtual void renew(std::span<const double> right) = 0;

  /// W = H A^-1 H^T, (m, m), symmetric, both triangles filled. Valid after factorise().
  virtual const MatrixX& compliance() const = 0;
  /// Free motion H A^-1 b, (m,).
  virtual const VectorX& free_motion() const = 0;
  /// b^T A^-1 b: twice the energy of the unconstrained step.
  virtual double free_energy() const = 0;
  /// Solves x = A^-1 (b + H^T effort) by one backward substitution. effort (m,), x (3 n,).
  virtual void solve_with_effort(std::span<const double> effort, std::span<double> x) = 0;
  /// Solves x = A^-1 right by forward and backward substitution, for `count` contiguous right-hand
  /// sides (3 n,). x may be right.
  virtual void solve(std::span<const double> right, std::span<double> x, int count = 1) = 0;

  /// Condenses A onto transient rows H_t, in addition to the border. The results are valid until
  /// the next factorise() or condense_transient().
  /// @param rows k groups of three rows on the same nodes.
  /// @param values 3 * rows.entries() doubles, layout of BorderPattern.
  virtual void condense_transient(const BorderPattern& rows, std::span<const double> values) = 0;
  /// H_t A^-1 H_t^T, lower triangle only, in the leading block (3 k, 3 k).
  virtual const MatrixX& transient_compliance() const = 0;
  /// H_t A^-1 H^T and, as the last column, H_t A^-1 b, in the leading block (3 k, m + 1).
  virtual const MatrixX& transient_coupling() const = 0;

  /// Number of negative pivots (inertia of A) of the last factorisation, if the solver counts them.
  virtual std::optional<int> negative_pivots() const = 0;
  /// Memory of this object in bytes, without the plan.
  virtual std::size_t bytes() const = 0;
};

/// Symbolic phase: ordering, elimination tree, supernodes, task lists.
class FactorisationPlan {
 public:
  virtual ~FactorisationPlan() = default;
  virtual std::string_view backend() const = 0;
  /// "amd" or "metis": the ordering in use.
  virtual std::string_view ordering() const = 0;
  /// Number of doubles in the factor L, and of floating-point operations of one factorisation, with
  /// border.
  virtual std::size_t factor_entries() const = 0;
  virtual double factor_flops() const = 0;
  /// Creates a numeric factorisation. @param pool used by every numeric call; must outlive the
  /// object.
  virtual std::unique_ptr<Factorisation> create(ThreadPool& pool) const = 0;
};

/// Makes a plan, or returns an existing one that is in use for the same patterns and settings, so
/// that robots that differ only in material share a plan. Thread-safe. Throws Error: unknown-choice
/// (backend), out-of-range (threads), index-out-of-range (invalid patterns).
/// @param pattern,border,settings of the factorisation.
std::shared_ptr<const FactorisationPlan> analyse(const BlockPattern& pattern,
                                                 const BorderPattern& border,
                                                 const FactorisationSettings& settings = {});

/// Checks settings as analyse() does. Throws Error: unknown-choice (backend), out-of-range
/// (threads).
void check_settings(const FactorisationSettings& settings);

/// A possible value of FactorisationSettings::backend.
struct BackendName {
  std::string name;
  std::string description;  ///< in the reference of scenes
};
/// All of them, in the order in which they were registered.
std::vector<BackendName> backends();

}  // namespace sinew::linalg
