/// @file
/// A cone problem whose matrix is sparse.
#pragma once

#include <span>

#include <Eigen/SparseCore>

#include "sinew/qp/cone_solver.hpp"

namespace sinew::qp {

/// As ConeProblem, with both triangles of the matrix stored, compressed by columns.
struct SparseConeProblem {
  const Eigen::SparseMatrix<double>& matrix;
  Eigen::Ref<const VectorX> offset;
  std::span<const BoxBlock> boxes;
  std::span<const ConeBlock> cones;
};

}  // namespace sinew::qp
