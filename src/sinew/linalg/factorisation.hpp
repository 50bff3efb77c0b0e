/// @file
/// Factorisation of A, symmetric in 3x3 blocks, bordered by constraint rows H, and what a step asks
/// of it: compliance W = H A^-1 H^T, the free motion H A^-1 b seen by the rows, and one backward
/// solve. Plan (immutable, shared between simulations and threads) and numbers (per simulation)
/// are apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/core/types.hpp"
#include "sinew/linalg/block_pattern.hpp"
#include "sinew/linalg/factor_status.hpp"

namespace sinew::linalg {

/// `fastest` tries both when the plan is made and keeps the one whose factorisation is estimated to
/// be faster, nested dissection (metis) if they are close, because it leaves more for threads to
/// do. The estimate counts operations and list lengths and reads no clock: the same pattern gets
/// the same order, and so the same bits, on every run and for any number of threads.
enum class Ordering { amd, metis, fastest };

struct FactorisationSettings {
  std::string backend = "block";  ///< "block" (ours), "eigen-ldlt", "eigen-llt": see backends()
  Ordering ordering = Ordering::fastest;
  int threads = 1;  ///< size of the pool that numeric phases will be given

  bool operator==(const FactorisationSettings&) const = default;
};

/// Numeric phase, one per simulation. After construction nothing allocates, but the first
/// factorise() where no other factorisation of the plan has given memory back.
class Factorisation {
 public:
  virtual ~Factorisation() = default;

  /// Factorises A bordered by H and b.
  /// @param matrix kBlockStride * pattern.blocks() doubles, layout of BlockPattern.
  /// @param border 3 * border.entries() doubles, layout of BorderPattern.
  /// @param right (3 n,) b.
  virtual FactorStatus factorise(std::span<const double> matrix, std::span<const double> border,
                                 std::span<const double> right) = 0;

  /// Lends the memory of the factor to other factorisations of the plan, until the next
  /// factorise(). Results stay; solving and condensing throw Error(internal) until then.
  virtual void release() {}

  /// W = H A^-1 H^T, (m, m), symmetric, both triangles filled. Valid after factorise().
  virtual const MatrixX& compliance() const = 0;
  /// H A^-1 b, (m,).
  virtual const VectorX& free_motion() const = 0;
  /// b^T A^-1 b: twice the energy of the unconstrained step.
  virtual double free_energy() const = 0;
  /// x = A^-1 (b + H^T effort); one backward substitution. effort (m,), x (3 n,).
  virtual void solve_with_effort(std::span<const double> effort, std::span<double> x) = 0;
  /// x = A^-1 right for any right side (3 n,), forward and backward; for rows that come and go.
  /// `count` right sides stand one behind the other. In place allowed.
  virtual void solve(std::span<const double> right, std::span<double> x, int count = 1) = 0;

  /// Forward substitution of transient rows H_t, which come and go beside the border. Valid until
  /// the next factorise() or condense_transient().
  /// @param rows k groups of three on the same nodes.
  /// @param values 3 * rows.entries() doubles, layout of BorderPattern.
  virtual void condense_transient(const BorderPattern& rows, std::span<const double> values) = 0;
  /// (3 k, 3 k) leading block: H_t A^-1 H_t^T, the lower triangle alone.
  virtual const MatrixX& transient_compliance() const = 0;
  /// (3 k, m + 1) leading block: H_t A^-1 H^T, then H_t A^-1 b.
  virtual const MatrixX& transient_coupling() const = 0;

  /// The number of negative pivots (inertia of A) of the last factorisation.
  virtual int negative_pivots() const = 0;
  /// Bytes held by this object alone (the plan not counted).
  virtual std::size_t bytes() const = 0;
};

/// Symbolic phase: ordering, elimination tree, supernodes, task lists.
class FactorisationPlan {
 public:
  virtual ~FactorisationPlan() = default;
  virtual std::string_view backend() const = 0;
  /// "amd" or "metis": the ordering in use.
  virtual std::string_view ordering() const = 0;
  /// Doubles in the factor L, and floating-point operations of one factorisation, border included.
  virtual std::size_t factor_entries() const = 0;
  virtual double factor_flops() const = 0;
  /// @param pool used by every numeric call; must outlive the object.
  virtual std::unique_ptr<Factorisation> create(ThreadPool& pool) const = 0;
};

/// Makes a plan, or finds it: whoever asks for the same patterns and settings while a plan of them
/// is in use gets that plan, so that robots which differ in their materials share one. Safe from
/// several threads. Throws Error(unknown-choice) for an unknown backend.
/// @param pattern,border,settings see there.
std::shared_ptr<const FactorisationPlan> analyse(const BlockPattern& pattern,
                                                 const BorderPattern& border,
                                                 const FactorisationSettings& settings = {});

/// Throws what analyse() throws of its settings: Error: unknown-choice (backend), out-of-range
/// (threads).
void check_settings(const FactorisationSettings& settings);

/// The names that `FactorisationSettings::backend` takes.
std::vector<std::string> backends();

}  // namespace sinew::linalg
