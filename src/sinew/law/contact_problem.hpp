/// @file
/// The contact problem of a step, in the form of the FCLIB collection.
#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "sinew/core/types.hpp"

namespace sinew::law {

/// Contact problem u = compliance r + motion with Signorini's and Coulomb's laws at n points. All
/// other blocks keep the states with which the step was solved: a held motion stays held, and a row
/// at a limit keeps its effort. `effort` therefore solves this problem as well as the step.
struct ContactProblem {
  /// W (3n, 3n) m/N, both triangles; per point the normal, then two tangents. 3x3 blocks of zeros,
  /// between points on uncoupled bodies, are omitted.
  Eigen::SparseMatrix<double> compliance;
  VectorX motion;                ///< q (3n,) m: gap and slip of the step without contact forces
  std::vector<double> friction;  ///< (n,) Coulomb's coefficients
  VectorX effort;                ///< r (3n,) N, solution of the step
};

}  // namespace sinew::law
