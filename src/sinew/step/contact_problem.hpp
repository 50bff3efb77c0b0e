/// @file
/// The contacts of a step by themselves, as the FCLIB collection poses them.
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"

namespace sinew::step {

/// u = compliance r + motion with Signorini's and Coulomb's laws at n points. Everything else of
/// the step keeps the state that it was solved with: what held a motion follows, what was at a
/// limit has its effort. `effort` therefore solves it, and solves the step.
struct ContactProblem {
  /// W (3n, 3n) m/N, both triangles; of each point the normal, then two tangents. Blocks of 3x3
  /// zeros, of points on bodies that have nothing in common, are left out.
  Eigen::SparseMatrix<double> compliance;
  VectorX motion;                ///< q (3n,) m: gap and slip of the step without contact forces
  std::vector<double> friction;  ///< (n,) Coulomb's coefficients
  VectorX effort;                ///< r (3n,) N, that the step found
};

}  // namespace sinew::step
