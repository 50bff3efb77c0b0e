#include "sinew/collision/normal_cones.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

namespace {

constexpr int kConeGrain = 256;
// Triangles whose height is less than this part of their longest side exclude nothing.
constexpr double kLeastHeight = 1e-3;
// cos 30 degrees: the edges of triangles with a narrower cone are no ridges.
constexpr double kRidge = 0.8660254037844386;
// Axes whose sum is shorter than this form no cone.
constexpr double kLeastSum = 1e-3;

Vector3 unit_normal(const Corners& x) {
  const Vector3 u = x[1] - x[0], v = x[2] - x[0], normal = u.cross(v);
  const double longest2 = std::max({u.squaredNorm(), v.squaredNorm(), (x[2] - x[1]).squaredNorm()});
  const double area = normal.norm();
  return area > kLeastHeight * longest2 ? Vector3(normal / area) : Vector3(Vector3::Zero());
}

}  // namespace

// Let A, alpha be the axis and half angle of the cone of a triangle, and n the normal of a pair,
// which points from its second feature to its first one (PairSearch).
// - Vertex over a face: n is the normal of the face, so it lies in the second cone.
// - Vertex over an edge: n lies between the normals of the triangles of the edge, so it lies in the
//   second cone.
// - Two vertices: n . e <= 0 for all edges e of the second vertex (the first one may be nearest
//   only up to a slack). Let n be tilted by t from A; its part across A lies in the azimuth of one
//   of the triangles at the vertex. The direction in that triangle with this azimuth is a
//   non-negative combination of two edges and rises by at most alpha over the plane across A, so
//   t <= alpha, or t >= 180 degrees - alpha, where n points into the body.
// In each case n . m <= 0 for the normal m of the first vertex, a non-negative combination of the
// normals of its triangles: the angle between the axes is at least 90 degrees - alpha - beta.
// - Two edges: n and -n lie in the cones, widened by the slack for edges, which is negligible
//   unless both edges are ridges: the angle is at least 180 degrees - alpha - beta.
// Points that coincide while their surfaces face the same way have no normal, and are no contact.
void NormalCones::update(const SurfaceTree& surface, ThreadPool& pool) {
  const SurfaceTopology& topology = surface.topology();
  cones_.clear();
  branches_.clear();
  if (!topology.closed()) return;
  const std::size_t count = topology.triangles().size();
  normals_.resize(count);
  cones_.resize(count);
  pool.for_range(static_cast<int>(count), kConeGrain, [&](int begin, int end, int) {
    for (int t = begin; t < end; ++t) {
      normals_[static_cast<std::size_t>(t)] = unit_normal(surface.corners(t));
    }
  });
  pool.for_range(static_cast<int>(count), kConeGrain, [&](int begin, int end, int) {
    for (int t = begin; t < end; ++t) {
      cones_[static_cast<std::size_t>(t)] = cone_of(topology, t);
    }
  });
  join(surface);
}

NormalCones::Cone NormalCones::cone_of(const SurfaceTopology& topology, int triangle) const {
  const auto own = static_cast<std::size_t>(triangle);
  const Vector3& axis = normals_[own];
  double cosine = 1.0;
  for (const NodeId node : topology.triangles()[own]) {
    for (const int other : topology.triangles_of_node(node)) {
      cosine = std::min(cosine, axis.dot(normals_[static_cast<std::size_t>(other)]));
    }
  }
  if (!(cosine > 0.0)) return {};  // too wide, or next to a degenerate triangle
  return {axis, cosine, std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), cosine < kRidge};
}

// A cone about the bisector of both axes. Its half angle is that between the bisector and an axis,
// plus the larger half angle.
NormalCones::Cone NormalCones::merged(const Cone& a, const Cone& b) {
  const Vector3 sum = a.axis + b.axis;
  const double length = sum.norm();
  if (!(length > kLeastSum)) return {};
  const Vector3 axis = sum / length;
  const Cone& wide = a.cosine < b.cosine ? a : b;
  const double turn = std::min(1.0, axis.dot(wide.axis));
  const double cosine =
      turn * wide.cosine - std::sqrt(std::max(0.0, 1.0 - turn * turn)) * wide.sine - kRounding;
  if (!(cosine > 0.0)) return {};
  return {axis, cosine, std::sqrt(std::max(0.0, 1.0 - cosine * cosine)),
          a.has_ridge || b.has_ridge};
}

void NormalCones::join(const SurfaceTree& surface) {
  const auto& tree = surface.branches();
  const auto& order = surface.order();
  branches_.resize(tree.size());
  for (std::size_t k = tree.size(); k-- > 0;) {
    const SurfaceTree::Branch& branch = tree[k];
    if (branch.right >= 0) {
      branches_[k] = merged(branches_[k + 1], branches_[static_cast<std::size_t>(branch.right)]);
      continue;
    }
    const auto cone = [&](int place) -> const Cone& {
      return cones_[static_cast<std::size_t>(order[static_cast<std::size_t>(place)])];
    };
    branches_[k] = cone(branch.begin);
    for (int i = branch.begin + 1; i < branch.end; ++i) {
      branches_[k] = merged(branches_[k], cone(i));
    }
  }
}

}  // namespace sinew::collision
