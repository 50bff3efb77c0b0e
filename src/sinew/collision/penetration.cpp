#include "sinew/collision/penetration.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "sinew/collision/triangle_intersection.hpp"
#include "sinew/core/error.hpp"

namespace sinew::collision {

namespace {

constexpr int kInsideGrain = 32;
constexpr int kCrossingGrain = 64;

InsideVertex describe(const SurfaceTree& other, NodeId node, const Vector3& point) {
  const NearestOnSurface nearest = nearest_on_surface(other, point);
  const Vector3 way = nearest.point - point;
  const Corners x = other.corners(nearest.triangle);
  const Vector3 normal = nearest.distance > 0.0 ? (way / nearest.distance).eval()
                                                : (x[1] - x[0]).cross(x[2] - x[0]).normalized();
  return {node, nearest.distance, normal, nearest};
}

bool have_common_node(const SurfaceTopology& topology, const TrianglePair& pair) {
  const Triangle& a = topology.triangles()[static_cast<std::size_t>(pair.first)];
  const Triangle& b = topology.triangles()[static_cast<std::size_t>(pair.second)];
  return std::ranges::any_of(a, [&](NodeId node) { return std::ranges::find(b, node) != b.end(); });
}

}  // namespace

void require_closed(const SurfaceTopology& topology, const char* item) {
  if (topology.closed()) return;
  throw Error(ErrorKind::surface_not_closed, {.item = item},
              "the surface has edges without two triangles that run along them in opposite ways",
              "close its holes and let all triangles turn the same way");
}

Penetration::Penetration(ThreadPool& pool) : near_(pool), inside_(pool), crossing_(pool) {}

std::span<const InsideVertex> Penetration::inside(const SurfaceTree& own,
                                                  const SurfaceTree& other) {
  require_closed(other.topology(), "other");
  const Box& whole = other.branches().front().box;
  return inside_.collect(own.topology().node_count(), kInsideGrain,
                         [&](int begin, int end, std::vector<InsideVertex>& found) {
                           for (NodeId node = begin; node < end; ++node) {
                             if (own.topology().triangles_of_node(node).empty()) continue;
                             const Vector3 x = own.at(node);
                             Box point;
                             point.extend(x);
                             if (point.is_apart(whole, 0.0)) continue;
                             if (winding_number(other, x) <= 0) continue;
                             found.push_back(describe(other, node, x));
                           }
                         });
}

std::span<const TrianglePair> Penetration::crossing(const SurfaceTree& first,
                                                    const SurfaceTree& second) {
  return keep_crossing(first, second, near_.between(first, second, 0.0));
}

std::span<const TrianglePair> Penetration::crossing_within(const SurfaceTree& surface) {
  return keep_crossing(surface, surface, near_.within(surface, 0.0));
}

std::span<const TrianglePair> Penetration::keep_crossing(const SurfaceTree& first,
                                                         const SurfaceTree& second,
                                                         std::span<const TrianglePair> near) {
  const bool same = &first == &second;
  return crossing_.collect(
      static_cast<int>(near.size()), kCrossingGrain,
      [&](int begin, int end, std::vector<TrianglePair>& found) {
        for (int k = begin; k < end; ++k) {
          const TrianglePair& pair = near[static_cast<std::size_t>(k)];
          if (same && have_common_node(first.topology(), pair)) continue;
          if (triangles_meet(first.corners(pair.first), second.corners(pair.second))) {
            found.push_back(pair);
          }
        }
      });
}

}  // namespace sinew::collision
