#include "sinew/mesh/distance.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

namespace sinew::mesh {

namespace {

Vector3 nearest_point_on_segment(const Vector3& point, const Vector3& a, const Vector3& b) {
  const Vector3 edge = b - a;
  const double length2 = edge.squaredNorm();
  if (!(length2 > 0.0)) return a;
  return a + std::clamp((point - a).dot(edge) / length2, 0.0, 1.0) * edge;
}

}  // namespace

std::array<double, 4> barycentric_weights(const Vector3& point, const Corners& x) {
  // Ratios of volumes (Cramer's rule).
  const Vector3 e1 = x[1] - x[0], e2 = x[2] - x[0], e3 = x[3] - x[0], p = point - x[0];
  const double determinant = e1.dot(e2.cross(e3));
  const double w1 = p.dot(e2.cross(e3)) / determinant;
  const double w2 = p.dot(e3.cross(e1)) / determinant;
  const double w3 = p.dot(e1.cross(e2)) / determinant;
  return {1.0 - w1 - w2 - w3, w1, w2, w3};
}

Vector3 nearest_point_on_triangle(const Vector3& point, const Vector3& a, const Vector3& b,
                                  const Vector3& c) {
  const Vector3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0.0) {
    // Inside the prism over the triangle: project. Otherwise an edge is nearest.
    const double u = (c - b).cross(point - b).dot(normal);
    const double v = (a - c).cross(point - c).dot(normal);
    const double w = (b - a).cross(point - a).dot(normal);
    if (u >= 0.0 && v >= 0.0 && w >= 0.0) return (u * a + v * b + w * c) / (u + v + w);
  }
  Vector3 best = a;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &c), std::pair(&c, &a)}) {
    const Vector3 candidate = nearest_point_on_segment(point, *from, *to);
    const double distance = (candidate - point).squaredNorm();
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

double distance_to_tetrahedron(const Vector3& point, const Corners& x) {
  const auto weights = barycentric_weights(point, x);
  if (*std::min_element(weights.begin(), weights.end()) >= 0.0) return 0.0;
  constexpr std::array<std::array<std::size_t, 3>, 4> kFaces = {
      {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [i, j, k] : kFaces) {
    least = std::min(least, (nearest_point_on_triangle(point, x[i], x[j], x[k]) - point).norm());
  }
  return least;
}

}  // namespace sinew::mesh
