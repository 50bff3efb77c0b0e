#include "sinew/material/polar_decomposition.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "sinew/core/types.hpp"

namespace sinew::material::detail {

void polar_by_svd(const Lanes3x3& f, int lane, PolarDecomposition& result) {
  Matrix3 matrix;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) matrix(r, c) = f[r][c][lane];
  }
  if (!matrix.allFinite()) return;
  const Eigen::JacobiSVD<Matrix3> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 u = svd.matrixU();
  Vector3 s = svd.singularValues();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) {
    u.col(2) *= -1.0;
    s[2] *= -1.0;
  }
  const Matrix3 rotation = u * svd.matrixV().transpose();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) result.rotation[r][c][lane] = rotation(r, c);
  }
  result.trace[lane] = s.sum();
  result.pair_sums[lane] = (s[0] + s[1]) * (s[1] + s[2]) * (s[2] + s[0]);
}

}  // namespace sinew::material::detail
