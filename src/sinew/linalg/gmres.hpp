/// @file
/// GMRES, the generalised minimal residual method (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7,
/// 1986).
#pragma once

#include <functional>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::linalg {

/// Solves A x = b using only products with A. Memory grows as needed and is kept.
class Gmres {
 public:
  /// Computes product <- A direction. Both are (n,) and do not alias.
  using Operator =
      std::function<void(const Eigen::Ref<const VectorX>& direction, Eigen::Ref<VectorX> product)>;

  /// @param max_directions maximum number of products with A, and of stored (n,) vectors.
  /// @param tolerance of |A x - b|/|b|, at which the solver stops.
  Gmres(int max_directions, double tolerance)
      : max_directions_(max_directions), tolerance_(tolerance) {}

  /// Computes the vector with the smallest |A x - b| in the Krylov space.
  /// @param multiply multiplies by A. @param x (n,) in: b; out: x.
  /// @return |A x - b|/|b|; 0 if b is zero, NaN if b is not finite.
  double solve(const Operator& multiply, Eigen::Ref<VectorX> x);

 private:
  int max_directions_;
  double tolerance_;
  ScratchMatrix basis_;       // (n, directions + 1), orthonormal
  ScratchMatrix hessenberg_;  // (directions + 1, directions), triangular after the rotations
  ScratchMatrix rotations_;   // (2, directions) cosines and sines
  ScratchMatrix right_;       // (directions + 1, 1)
};

}  // namespace sinew::linalg
