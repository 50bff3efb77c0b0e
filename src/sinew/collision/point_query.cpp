#include "sinew/collision/point_query.hpp"

#include <array>
#include <cmath>

#include "sinew/collision/closest_points.hpp"
#include "sinew/collision/orientation.hpp"

namespace sinew::collision {

namespace {

/// At most one branch per level waits, and halving makes fewer than 32 levels.
constexpr std::size_t kBranchStack = 64;
constexpr int kAxis = 0;  // of the ray

double squared_distance(const Box& box, const Vector3& point) {
  return (box.low - point).cwiseMax(point - box.high).cwiseMax(0.0).squaredNorm();
}

void take_nearer(const SurfaceTree& surface, const Vector3& point, int triangle,
                 NearestOnSurface& best) {
  const Corners x = surface.corners(triangle);
  const OnTriangle on = closest_on_triangle(point, x[0], x[1], x[2]);
  const double distance = (on.point - point).norm();
  if (distance > best.distance) return;
  if (distance == best.distance && best.triangle >= 0 && best.triangle < triangle) return;
  best = {triangle, on.weights, on.point, distance};
}

// Signed crossing of the edge a b, seen along the ray: it counts if the edge crosses the height of
// the point and leaves it on its left. Edges are half-open in height.
int crossing(const Vector3& a, const Vector3& b, const Vector3& point) {
  constexpr int kHeight = (kAxis + 2) % 3;
  const bool below_a = point[kHeight] < a[kHeight], below_b = point[kHeight] < b[kHeight];
  if (below_a == below_b) return 0;
  const int side = orientation_along(kAxis, a, b, point);
  if (below_b) return side > 0 ? 1 : 0;
  return side < 0 ? -1 : 0;
}

// Contribution of a triangle to the winding number: 1 if the ray leaves through it, -1 if it
// enters.
int signed_crossing(const Corners& x, const Vector3& point) {
  const int turns =
      crossing(x[0], x[1], point) + crossing(x[1], x[2], point) + crossing(x[2], x[0], point);
  if (turns == 0) return 0;
  // If the point sees the triangle turn left, the ray runs towards the side of the normal.
  return orientation(x[0], x[1], x[2], point) * turns < 0 ? turns : 0;
}

}  // namespace

NearestOnSurface nearest_on_surface(const SurfaceTree& surface, const Vector3& point, double reach,
                                    const std::function<bool(int)>& skips) {
  const auto& branches = surface.branches();
  NearestOnSurface best;
  best.distance = reach;
  std::array<int, kBranchStack> open{0};
  std::size_t count = 1;
  const auto distance = [&](int k) {
    return squared_distance(branches[static_cast<std::size_t>(k)].box, point);
  };
  while (count > 0) {
    const int number = open[--count];
    if (std::sqrt(distance(number)) > best.distance * (1.0 + 4.0 * kEpsilon)) continue;
    const auto& branch = branches[static_cast<std::size_t>(number)];
    if (branch.right < 0) {
      for (int i = branch.begin; i < branch.end; ++i) {
        const int triangle = surface.order()[static_cast<std::size_t>(i)];
        if (!skips || !skips(triangle)) take_nearer(surface, point, triangle, best);
      }
      continue;
    }
    const bool left_first = distance(number + 1) <= distance(branch.right);
    open[count++] = left_first ? branch.right : number + 1;
    open[count++] = left_first ? number + 1 : branch.right;
  }
  if (best.triangle < 0) best.distance = kInfinity;
  return best;
}

int winding_number(const SurfaceTree& surface, const Vector3& point) {
  const auto& branches = surface.branches();
  const auto meets_ray = [&](const Box& box) {
    if (box.high[kAxis] < point[kAxis]) return false;
    for (const int axis : {(kAxis + 1) % 3, (kAxis + 2) % 3}) {
      if (box.low[axis] > point[axis] || box.high[axis] < point[axis]) return false;
    }
    return true;
  };
  int winding = 0;
  std::array<int, kBranchStack> open{0};
  std::size_t count = 1;
  while (count > 0) {
    const int number = open[--count];
    const auto& branch = branches[static_cast<std::size_t>(number)];
    if (!meets_ray(branch.box)) continue;
    if (branch.right < 0) {
      for (int i = branch.begin; i < branch.end; ++i) {
        const int triangle = surface.order()[static_cast<std::size_t>(i)];
        if (!meets_ray(surface.box(triangle))) continue;
        winding += signed_crossing(surface.corners(triangle), point);
      }
      continue;
    }
    open[count++] = branch.right;
    open[count++] = number + 1;
  }
  return winding;
}

}  // namespace sinew::collision
