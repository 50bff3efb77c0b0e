#include "sinew/mechanics/spread_points.hpp"

#include <Eigen/Geometry>

namespace sinew::mechanics {

namespace {

std::array<Eigen::Index, 3> spread_rows(const Points& points) {
  const Eigen::RowVector3d middle = points.colwise().mean();
  std::array<Eigen::Index, 3> found{};
  (points.rowwise() - middle).rowwise().squaredNorm().maxCoeff(&found[0]);
  const Eigen::RowVector3d a = points.row(found[0]);
  (points.rowwise() - a).rowwise().squaredNorm().maxCoeff(&found[1]);
  const Vector3 along = (points.row(found[1]) - a).normalized();
  double farthest = -1.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double distance = along.cross(Vector3(points.row(i) - a)).norm();
    if (distance <= farthest) continue;
    farthest = distance;
    found[2] = i;
  }
  return found;
}

}  // namespace

std::array<NodeId, 3> spread_points(const Points& points, std::span<const NodeId> among) {
  std::array<NodeId, 3> chosen{};
  const auto rows =
      among.empty() ? spread_rows(points) : spread_rows(Points(points(among, Eigen::all)));
  for (std::size_t k = 0; k < 3; ++k) {
    chosen[k] =
        among.empty() ? static_cast<NodeId>(rows[k]) : among[static_cast<std::size_t>(rows[k])];
  }
  return chosen;
}

double box_diagonal(const Points& points, const Matrix3& axes) {
  const Points own = points * axes;
  const Vector3 extent = own.colwise().maxCoeff() - own.colwise().minCoeff();
  return extent.norm();
}

}  // namespace sinew::mechanics
