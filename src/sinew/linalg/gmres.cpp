#include "sinew/linalg/gmres.hpp"

#include <cmath>
#include <limits>

namespace sinew::linalg {

double Gmres::solve(const Operator& multiply, Eigen::Ref<VectorX> x) {
  const double size = x.norm();
  if (size == 0.0) return 0.0;
  if (!std::isfinite(size)) return std::numeric_limits<double>::quiet_NaN();
  auto basis = basis_.shape(x.size(), max_directions_ + 1);
  auto triangle = hessenberg_.shape(max_directions_ + 1, max_directions_);
  auto rotations = rotations_.shape(2, max_directions_);
  auto right = right_.shape(max_directions_ + 1, 1);
  basis.col(0) = x / size;
  right.setZero();
  right(0, 0) = size;
  int count = 0;
  bool complete = false;
  while (count < max_directions_ && !complete && std::abs(right(count, 0)) > tolerance_ * size) {
    const int k = count++;
    auto next = basis.col(k + 1);
    multiply(basis.col(k), next);
    const double length = next.norm();
    for (int j = 0; j <= k; ++j) {
      triangle(j, k) = basis.col(j).dot(next);
      next -= triangle(j, k) * basis.col(j);
    }
    const double beyond = next.norm();
    complete = !(beyond > std::numeric_limits<double>::epsilon() * length);
    if (!complete) next /= beyond;
    for (int j = 0; j < k; ++j) {
      const double c = rotations(0, j), s = rotations(1, j), upper = triangle(j, k);
      triangle(j, k) = c * upper + s * triangle(j + 1, k);
      triangle(j + 1, k) = c * triangle(j + 1, k) - s * upper;
    }
    const double diagonal = std::hypot(triangle(k, k), beyond);
    if (!(diagonal > 0.0)) {  // A is singular: this direction adds nothing
      --count;
      break;
    }
    rotations(0, k) = triangle(k, k) / diagonal;
    rotations(1, k) = beyond / diagonal;
    triangle(k, k) = diagonal;
    right(k + 1, 0) = -rotations(1, k) * right(k, 0);
    right(k, 0) *= rotations(0, k);
  }
  auto weights = right.col(0).head(count);
  triangle.topLeftCorner(count, count).triangularView<Eigen::Upper>().solveInPlace(weights);
  const double left = std::abs(right(count, 0)) / size;
  x.noalias() = basis.leftCols(count) * weights;
  return left;
}

}  // namespace sinew::linalg
