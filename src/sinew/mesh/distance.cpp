#include "sinew/mesh/distance.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "sinew/collision/closest_points.hpp"

namespace sinew::mesh {

std::array<double, 4> barycentric_weights(const Vector3& point, const Corners& x) {
  // Ratios of volumes (Cramer's rule).
  const Vector3 e1 = x[1] - x[0], e2 = x[2] - x[0], e3 = x[3] - x[0], p = point - x[0];
  const double determinant = e1.dot(e2.cross(e3));
  const double w1 = p.dot(e2.cross(e3)) / determinant;
  const double w2 = p.dot(e3.cross(e1)) / determinant;
  const double w3 = p.dot(e1.cross(e2)) / determinant;
  return {1.0 - w1 - w2 - w3, w1, w2, w3};
}

Vector3 closest_on_tetrahedron(const Vector3& point, const Corners& x) {
  const auto weights = barycentric_weights(point, x);
  if (*std::min_element(weights.begin(), weights.end()) >= 0.0) return point;
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  Vector3 result = point;
  double least = kInfinity;
  for (const auto& [i, j, k] : kFaces) {
    const Vector3 nearest = collision::closest_on_triangle(point, x[i], x[j], x[k]).point;
    const double distance = (nearest - point).norm();
    if (distance >= least) continue;
    least = distance;
    result = nearest;
  }
  return result;
}

double distance_to_tetrahedron(const Vector3& point, const Corners& x) {
  return (closest_on_tetrahedron(point, x) - point).norm();
}

}  // namespace sinew::mesh
