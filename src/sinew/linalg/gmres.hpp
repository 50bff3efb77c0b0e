/// @file
/// Generalised minimal residuals (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7, 1986).
#pragma once

#include <functional>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::linalg {

/// Solves A x = b by products with A alone. Memory grows and is kept.
class Gmres {
 public:
  /// product <- A direction. Both are (n,), and apart from each other.
  using Operator =
      std::function<void(const Eigen::Ref<const VectorX>& direction, Eigen::Ref<VectorX> product)>;

  /// @param max_directions products with A, and (n,) vectors kept, at most.
  /// @param tolerance of |A x - b|/|b|, at which the solver ends.
  Gmres(int max_directions, double tolerance)
      : max_directions_(max_directions), tolerance_(tolerance) {}

  /// x <- the vector of least |A x - b| among those of the directions taken.
  /// @param multiply with A. @param x (n,) in: b.
  /// @return |A x - b|/|b|; 0 where b is zero, NaN where b is not finite.
  double solve(const Operator& multiply, Eigen::Ref<VectorX> x);

 private:
  int max_directions_;
  double tolerance_;
  ScratchMatrix basis_;       // (n, directions + 1), orthonormal
  ScratchMatrix hessenberg_;  // (directions + 1, directions), triangular after its rotations
  ScratchMatrix rotations_;   // (2, directions) cosine and sine
  ScratchMatrix right_;       // (directions + 1, 1)
};

}  // namespace sinew::linalg
