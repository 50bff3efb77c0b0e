#include "sinew/linalg/positive_part.hpp"

#include <Eigen/Eigenvalues>

namespace sinew::linalg {

Matrix3 positive_part(const Matrix3& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> pairs(matrix);
  const Matrix3& v = pairs.eigenvectors();
  return v * pairs.eigenvalues().cwiseMax(0.0).asDiagonal() * v.transpose();
}

}  // namespace sinew::linalg
