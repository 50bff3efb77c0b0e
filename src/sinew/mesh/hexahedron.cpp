#include "sinew/mesh/hexahedron.hpp"

#include <cmath>

#include <Eigen/LU>

namespace sinew::mesh {

namespace {

// VTK_HEXAHEDRON: four nodes around the lower face, then those above them.
constexpr double kCorner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                  {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

}  // namespace

std::array<double, 8> hexahedron_shapes(const Vector3& local) {
  std::array<double, 8> result{};
  for (std::size_t a = 0; a < 8; ++a) {
    result[a] = 0.125;
    for (int c = 0; c < 3; ++c) result[a] *= 1.0 + kCorner[a][c] * local[c];
  }
  return result;
}

Eigen::Matrix<double, 8, 3> hexahedron_gradients(const Vector3& local) {
  Eigen::Matrix<double, 8, 3> result;
  for (int a = 0; a < 8; ++a) {
    for (int d = 0; d < 3; ++d) {
      double value = 0.125 * kCorner[a][d];
      for (int c = 0; c < 3; ++c) {
        if (c != d) value *= 1.0 + kCorner[a][c] * local[c];
      }
      result(a, d) = value;
    }
  }
  return result;
}

const std::array<Vector3, 8>& hexahedron_points() {
  static const std::array<Vector3, 8> points = [] {
    std::array<Vector3, 8> result;
    const double at = 1.0 / std::sqrt(3.0);
    for (std::size_t a = 0; a < 8; ++a) {
      result[a] = at * Vector3(kCorner[a][0], kCorner[a][1], kCorner[a][2]);
    }
    return result;
  }();
  return points;
}

std::optional<Vector3> hexahedron_coordinates(const Vector3& point,
                                              const Eigen::Matrix<double, 8, 3>& corners) {
  constexpr int kIterations = 30;
  constexpr double kTolerance = 1e-13, kFarthest = 10.0;
  Vector3 local = Vector3::Zero();
  for (int k = 0; k < kIterations; ++k) {
    const auto shapes = hexahedron_shapes(local);
    Vector3 gap = point;
    for (int a = 0; a < 8; ++a) {
      gap -= shapes[static_cast<std::size_t>(a)] * corners.row(a).transpose();
    }
    const Matrix3 jacobian = corners.transpose() * hexahedron_gradients(local);
    const Vector3 step = jacobian.partialPivLu().solve(gap);
    local += step;
    if (!local.allFinite() || local.cwiseAbs().maxCoeff() > kFarthest) return std::nullopt;
    if (step.cwiseAbs().maxCoeff() < kTolerance) return local;
  }
  return std::nullopt;
}

}  // namespace sinew::mesh
