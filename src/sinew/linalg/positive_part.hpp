/// @file
/// Projection of a small symmetric matrix onto the positive semidefinite matrices.
#pragma once

#include "sinew/core/types.hpp"

namespace sinew::linalg {

/// Returns sum max(l_i, 0) v_i v_i^T over the eigenpairs (l_i, v_i), the nearest positive
/// semidefinite matrix in the Frobenius norm (Higham, Linear Algebra Appl. 103, 1988, theorem 2.1).
/// @param matrix symmetric; its lower triangle is read.
Matrix3 positive_part(const Matrix3& matrix);
Eigen::Matrix2d positive_part(const Eigen::Matrix2d& matrix);

}  // namespace sinew::linalg
