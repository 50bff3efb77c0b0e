#include "sinew/collision/closest_points.hpp"

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

namespace sinew::collision {

namespace {

// The nearest point of the three edges. A corner gives the same bits from both of its edges.
OnTriangle closest_on_border(const Vector3& point, const std::array<const Vector3*, 3>& corners) {
  OnTriangle best;
  double least = kInfinity;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const OnEdge on = closest_on_edge(point, *corners[k], *corners[next]);
    const double distance = (point - on.point).squaredNorm();
    if (!(distance < least)) continue;
    least = distance;
    best.point = on.point;
    best.weights.setZero();
    best.weights[static_cast<Eigen::Index>(k)] = 1.0 - on.share;
    best.weights[static_cast<Eigen::Index>(next)] = on.share;
  }
  return best;
}

}  // namespace

OnEdge closest_on_edge(const Vector3& point, const Vector3& a, const Vector3& b) {
  const Vector3 edge = b - a;
  const double along = edge.dot(point - a), length2 = edge.squaredNorm();
  if (!(along > 0.0) || !(length2 > 0.0)) return {0.0, a};
  if (along >= length2) return {1.0, b};
  const double share = along / length2;
  return {share, a + share * edge};
}

OnTriangle closest_on_triangle(const Vector3& point, const Vector3& a, const Vector3& b,
                               const Vector3& c) {
  const Vector3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0.0) {
    const Vector3 weights =
        Vector3((c - b).cross(point - b).dot(normal), (a - c).cross(point - c).dot(normal),
                (b - a).cross(point - a).dot(normal));
    if (weights.minCoeff() > 0.0) {
      const Vector3 scaled = weights / weights.sum();
      return {scaled, scaled[0] * a + scaled[1] * b + scaled[2] * c};
    }
  }
  return closest_on_border(point, {&a, &b, &c});
}

OnEdges closest_on_edges(const Vector3& a0, const Vector3& a1, const Vector3& b0,
                         const Vector3& b1) {
  const Vector3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  OnEdges best;
  double least = kInfinity;
  const auto consider = [&](double s, double t) {
    const double distance = (w + s * u - t * v).squaredNorm();
    if (!(distance < least)) return;
    least = distance;
    best.first = s;
    best.second = t;
  };
  const auto share = [](double along, double length2) {
    return length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
  };
  consider(0.0, share(vw, vv));
  consider(1.0, share(vw + uv, vv));
  consider(share(-uw, uu), 0.0);
  consider(share(uv - uw, uu), 1.0);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 0.0) {
    const double s = (uv * vw - vv * uw) / determinant;
    if (s > 0.0 && s < 1.0) consider(s, share(vw + s * uv, vv));
  }
  best.first_point = a0 + best.first * u;
  best.second_point = b0 + best.second * v;
  return best;
}

}  // namespace sinew::collision
