#include "sinew/linalg/positive_part.hpp"

#include <Eigen/Eigenvalues>

namespace sinew::linalg {

namespace {

template <class Matrix>
Matrix part_of(const Matrix& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix> pairs(matrix);
  const Matrix& v = pairs.eigenvectors();
  return v * pairs.eigenvalues().cwiseMax(0.0).asDiagonal() * v.transpose();
}

}  // namespace

Matrix3 positive_part(const Matrix3& matrix) { return part_of(matrix); }
Eigen::Matrix2d positive_part(const Eigen::Matrix2d& matrix) { return part_of(matrix); }

}  // namespace sinew::linalg
