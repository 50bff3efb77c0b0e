#include "sinew/collision/local_minimum.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sinew::collision {

namespace {

// Cosine of the angle within which normals face the same way; those of a square corner do not. And
// relative to a triangle's size: the distance from its plane within which a point lies in it.
constexpr double kSameWay = 0.1, kInPlane = 1e-6;

}  // namespace

// Compiled once: inlined copies might round differently.
[[gnu::noinline]] Vector3 LocalMinimum::weights(int triangle, const Vector3& point) const {
  const Corners x = surface_.corners(triangle);
  const Vector3 normal = (x[1] - x[0]).cross(x[2] - x[0]);
  const double area2 = normal.squaredNorm();
  if (!(area2 > 0.0)) return Vector3::Zero();
  return Vector3((x[2] - x[1]).cross(point - x[1]).dot(normal),
                 (x[0] - x[2]).cross(point - x[2]).dot(normal),
                 (x[1] - x[0]).cross(point - x[0]).dot(normal)) /
         area2;
}

[[gnu::noinline]] double LocalMinimum::share(int edge, const Vector3& point) const {
  const Edge& ends = surface_.topology().edges()[static_cast<std::size_t>(edge)];
  const Vector3 from = surface_.at(ends[0]), way = surface_.at(ends[1]) - from;
  const double length2 = way.squaredNorm();
  return length2 > 0.0 ? way.dot(point - from) / length2 : 0.0;
}

bool LocalMinimum::flush(int triangle, const Vector3& point, const Vector3& inward) const {
  const Vector3 normal = face_normal(triangle);
  const double area2 = normal.norm();
  if (normal.dot(inward) >= -kSameWay * area2 * inward.norm()) return false;
  const double height = normal.dot(point - surface_.corners(triangle)[0]) / area2;
  return std::abs(height) <= kInPlane * std::sqrt(area2);
}

bool LocalMinimum::over_edge(int edge, const Vector3& point, const Vector3& inward) const {
  const SurfaceTopology& topology = surface_.topology();
  bool any = false;
  for (const int triangle : topology.triangles_of_edge(edge)) {
    if (flush(triangle, point, inward)) continue;
    any = true;
    const auto& own = topology.edges_of(triangle);
    const Eigen::Index opposite = own[0] == edge ? 2 : own[1] == edge ? 0 : 1;
    if (weights(triangle, point)[opposite] > kBorder) return false;
  }
  return any;
}

bool LocalMinimum::over_vertex(NodeId node, const Vector3& point, const Vector3& inward) const {
  const SurfaceTopology& topology = surface_.topology();
  bool any = false;
  for (const int edge : topology.edges_of_node(node)) {
    const auto triangles = topology.triangles_of_edge(edge);
    if (std::ranges::all_of(triangles, [&](int t) { return flush(t, point, inward); })) continue;
    any = true;
    const bool first = topology.edges()[static_cast<std::size_t>(edge)][0] == node;
    const double along = share(edge, point);
    if (first ? along > kBorder : along < 1.0 - kBorder) return false;
  }
  return any;
}

bool LocalMinimum::is_within_slack(const Vector3& way, const Vector3& away) const {
  return away.dot(way) <= slack_ * way.norm();
}

bool LocalMinimum::vertex_is_nearest(NodeId node, const Vector3& point, const Vector3& away) const {
  if (over_vertex(node, point)) return true;
  const SurfaceTopology& topology = surface_.topology();
  const Vector3 here = surface_.at(node);
  return std::ranges::all_of(topology.edges_of_node(node), [&](int edge) {
    const Edge& ends = topology.edges()[static_cast<std::size_t>(edge)];
    return is_within_slack(surface_.at(ends[0] == node ? ends[1] : ends[0]) - here, away);
  });
}

bool LocalMinimum::edge_is_nearest(int edge, const Vector3& own, const Vector3& point,
                                   const Vector3& away) const {
  if (over_edge(edge, point)) return true;
  const SurfaceTopology& topology = surface_.topology();
  const Edge& ends = topology.edges()[static_cast<std::size_t>(edge)];
  return std::ranges::all_of(topology.triangles_of_edge(edge), [&](int triangle) {
    const auto& nodes = topology.triangles()[static_cast<std::size_t>(triangle)];
    return std::ranges::all_of(nodes, [&](NodeId node) {
      return node == ends[0] || node == ends[1] || is_within_slack(surface_.at(node) - own, away);
    });
  });
}

Vector3 LocalMinimum::face_normal(int triangle) const {
  const Corners x = surface_.corners(triangle);
  return (x[1] - x[0]).cross(x[2] - x[0]);
}

Vector3 LocalMinimum::edge_normal(int edge) const {
  Vector3 sum = Vector3::Zero();
  for (const int triangle : surface_.topology().triangles_of_edge(edge)) {
    sum += face_normal(triangle).normalized();
  }
  return sum;
}

Vector3 LocalMinimum::vertex_normal(NodeId node) const {
  const SurfaceTopology& topology = surface_.topology();
  Vector3 sum = Vector3::Zero();
  for (const int number : topology.triangles_of_node(node)) {
    const Triangle& t = topology.triangles()[static_cast<std::size_t>(number)];
    const std::size_t k = t[0] == node ? 0 : t[1] == node ? 1 : 2;
    const Vector3 u = surface_.at(t[(k + 1) % 3]) - surface_.at(node);
    const Vector3 v = surface_.at(t[(k + 2) % 3]) - surface_.at(node);
    const Vector3 normal = u.cross(v);
    sum += std::atan2(normal.norm(), u.dot(v)) * normal.normalized();
  }
  return sum;
}

}  // namespace sinew::collision
