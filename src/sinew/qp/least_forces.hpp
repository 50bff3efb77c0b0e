/// @file
/// Forces of least norm that cause a given motion, each within its own convex set. Independent of
/// physics beyond the cone.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/qp/bordered_factor.hpp"

namespace sinew::qp {

/// The set of efforts that one block may have.
struct EffortSet {
  enum class Kind : char {
    cone,      ///< three rows: |r_t| <= friction r_n
    ray,       ///< three rows: r = s (1, along), s >= 0
    interval,  ///< one row: lower <= r <= upper
  };
  Kind kind = Kind::interval;
  int row = 0;  ///< its first row
  double friction = 0.0;
  Eigen::Vector2d along = Eigen::Vector2d::Zero();
  double lower = 0.0, upper = kInfinity;

  int size() const { return kind == Kind::interval ? 1 : 3; }
};

/// Finds the solution of
///   min |z|^2/2   s.t.   W z = u,   z in K,
/// K a product of convex sets, W symmetric positive semidefinite of rank r < m. With W = B B^T,
/// B (m, r) from a Cholesky factorisation with diagonal pivoting (Higham, Accuracy and Stability of
/// Numerical Algorithms, 2002, sec. 10.3), and u = B c, the condition reads B^T z = c. Its dual
///   min_y  phi(y) = |B y|^2/2 - |B y - P_K(B y)|^2/2 - c.y,   z = P_K(B y),
/// has only r unknowns and no constraints; phi is convex with the gradient B^T P_K(B y) - c. It is
/// minimised by a semismooth Newton method with the matrix B^T P_K' B (Qi & Sun, Math. Program. 58
/// (1993) 353; for such projections Malick, SIAM J. Matrix Anal. Appl. 26 (2004) 272). If no z in K
/// causes u, phi decreases without bound. The solution is unique: it depends neither on the order
/// of the rows nor on the pivots.
class LeastForces {
 public:
  /// A row whose independent part is below this fraction of its own W_ii moves only with others.
  static constexpr double kDependent = 1e-10;

  /// Factorises W. Allocates only if W is larger than any before. @param matrix (m, m) W.
  /// @param own (m,) size of each row's W_ii before anything was eliminated from it, > 0.
  /// @return false if W is indefinite.
  bool factorise(const Eigen::Ref<const MatrixX>& matrix, std::span<const double> own);
  Eigen::Index rank() const { return rank_; }
  /// Replaces a motion by the nearest one that efforts can cause, to the accuracy of its rounding:
  /// it agrees in the r rows of the pivots. It is the u of find().
  /// @param motion (m,). @return the largest change.
  double fit(Eigen::Ref<VectorX> motion);
  /// Finds the efforts of least norm. @param sets cover all rows. @param effort (m,) the result.
  /// @return false if there are none. `effort` is then undefined.
  bool find(std::span<const EffortSet> sets, Eigen::Ref<VectorX> effort);
  /// Whether efforts of K without any limits, other than zero, cause no motion: bodies that are
  /// wedged can press on each other without a load. Intervals with two limits count as zero.
  /// @param sets as for find().
  bool has_self_stress(std::span<const EffortSet> sets);
  /// Newton steps of the last find().
  int steps() const { return steps_; }

 private:
  double project(std::span<const EffortSet> sets);
  bool newton(std::span<const EffortSet> sets);
  bool needs_more(double size) const;
  bool form_step(std::span<const EffortSet> sets, double shift);
  double evaluate(std::span<const EffortSet> sets);
  void start();

  Eigen::Index rows_ = 0, rank_ = 0;
  double unit_ = 1.0;                             // mean of W_ii, to which W is scaled
  linalg::ScratchMatrix columns_;                 // (m, r) B
  linalg::ScratchMatrix slopes_;                  // (m, r) P_K' B
  std::vector<int> pivots_;                       // (r,)
  std::vector<char> taken_;                       // (m,)
  linalg::AlignedNumbers left_;                   // (m,) diagonal that is left
  linalg::ScratchMatrix dual_, trial_;            // (r, 1) y
  linalg::ScratchMatrix goal_, gradient_, step_;  // (r, 1)
  linalg::ScratchMatrix aim_, effort_, shift_;    // (m, 1) B y, P_K(B y), and what is added to B y
  std::vector<EffortSet> open_;                   // without limits, see has_self_stress()
  BorderedFactor factor_;
  int steps_ = 0;
};

}  // namespace sinew::qp
