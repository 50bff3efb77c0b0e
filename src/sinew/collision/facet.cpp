#include "sinew/collision/facet.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace sinew::collision {

namespace {

// Sine of the angle below which faces are seen edge-on and omitted: a point clipped with a slack
// lies off such a face by the slack divided by this.
constexpr double kEdgeOn = 1e-3;

// The range of shares of a segment that is kept, from its first end.
struct Range {
  double from = 0.0, to = 1.0;
  int from_cut = -1, to_cut = -1;

  // Keeps the part where a value that runs linearly from `start` to `end` is below 0.
  // @param side cuts off the rest.
  bool keep_below(double start, double end, double slack, int side) {
    if (start > slack && end > slack) return false;
    if (start > slack) keep_from(std::min(start / (start - end), 1.0), side);
    if (end > slack) keep_to(std::max(start / (start - end), 0.0), side);
    return true;
  }
  void keep_from(double share, int side) {
    if (!(share > from)) return;
    from = share;
    from_cut = side;
  }
  void keep_to(double share, int side) {
    if (!(share < to)) return;
    to = share;
    to_cut = side;
  }
};

bool clip_to_polygon(const Vector3& from, const Vector3& to, const Facet& polygon,
                     const Vector3& direction, double slack, Range& range) {
  for (std::size_t k = 0; k < polygon.corner_count; ++k) {
    const Vector3& corner = polygon.corners[k];
    const Vector3 edge = polygon.corners[(k + 1) % polygon.corner_count] - corner;
    Vector3 out = edge.cross(direction);
    if (out.dot(polygon.centre - corner) > 0.0) out = -out;
    const double length = out.norm();
    if (!(length > 0.0)) continue;
    if (!range.keep_below(out.dot(from - corner) / length, out.dot(to - corner) / length, slack,
                          static_cast<int>(k))) {
      return false;
    }
  }
  return range.from <= range.to;
}

bool clip_to_disc(const Vector3& from, const Vector3& to, const Facet& disc,
                  const Vector3& direction, double slack, Range& range) {
  const Vector3 start = disc.cast(from, direction) - disc.centre;
  const Vector3 way = disc.cast(to, direction) - disc.centre - start;
  const double square = way.squaredNorm();
  const double middle = square > 0.0 ? -way.dot(start) / square : 0.0;
  const double nearest = (start + middle * way).norm();
  if (nearest > disc.radius + slack) return false;
  if (!(square > 0.0)) return true;
  const double half =
      std::sqrt(std::max(0.0, (disc.radius - nearest) * (disc.radius + nearest)) / square);
  const double ends = slack / std::sqrt(square);  // an end on the rim stays
  if (middle - half > 1.0 + ends || middle + half < -ends) return false;
  range.keep_from(std::min(middle - half, 1.0), 0);
  range.keep_to(std::max(middle + half, 0.0), 0);
  return true;
}

}  // namespace

Vector3 Facet::cast(const Vector3& point, const Vector3& direction) const {
  return point + normal.dot(centre - point) / normal.dot(direction) * direction;
}

Facets::Facets(const Plane& plane) {
  add() = {.kind = Facet::Kind::half_space, .centre = plane.point, .normal = plane.normal};
}

Facets::Facets(const SymmetricSolid& solid, const Vector3& direction) {
  const Vector3 local = solid.axes.transpose() * direction;
  if (solid.half_size.minCoeff() > 0.0) {
    add_faces(solid, local);
    return;
  }
  if (solid.half_size[2] > 0.0) add_line(solid, direction);
  if (solid.rim > 0.0 && std::abs(local[2]) > kEdgeOn) {
    const int side = local[2] > 0.0 ? 1 : 0;
    add() = {.kind = Facet::Kind::disc,
             .centre = solid.end(side),
             .normal = std::copysign(1.0, local[2]) * solid.axis(),
             .radius = solid.rim,
             .end = side};
  }
}

void Facets::add_faces(const SymmetricSolid& solid, const Vector3& local) {
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(local[k]) > kEdgeOn)) continue;
    const double side = std::copysign(1.0, local[k]);
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vector3 u = solid.half_size[i] * solid.axes.col(i);
    const Vector3 v = solid.half_size[j] * solid.axes.col(j);
    const Vector3 normal = side * solid.axes.col(k);
    const Vector3 centre = solid.centre + solid.half_size[k] * normal;
    // Corners are named by their signs along the axes, one bit per axis.
    const int bi = 1 << i, bj = 1 << j, base = side > 0.0 ? 1 << k : 0;
    add() = {.kind = Facet::Kind::polygon,
             .centre = centre,
             .normal = normal,
             .corners = {centre + u + v, centre - u + v, centre - u - v, centre + u - v},
             .names = {base + bi + bj, base + bj, base, base + bi},
             .corner_count = 4,
             .face = 2 * k + (side > 0.0 ? 1 : 0)};
  }
}

void Facets::add_line(const SymmetricSolid& solid, const Vector3& direction) {
  const Vector3 across = solid.axis().cross(direction).cross(solid.axis());
  const double length = across.norm();
  Vector3 out = solid.radius * direction;
  if (solid.rim > 0.0) {
    if (!(length > kEdgeOn)) return;
    out = solid.rim / length * across;
  }
  add() = {.kind = Facet::Kind::line,
           .centre = solid.centre + out,
           .corners = {solid.end(0) + out, solid.end(1) + out},
           .names = {0, 1},
           .corner_count = 2};
}

Clipped clip(const Vector3& from, const Vector3& to, const Facet& facet, const Vector3& direction,
             double slack) {
  Range range;
  if (facet.kind == Facet::Kind::polygon &&
      !clip_to_polygon(from, to, facet, direction, slack, range)) {
    return {};
  }
  if (facet.kind == Facet::Kind::disc && !clip_to_disc(from, to, facet, direction, slack, range)) {
    return {};
  }
  const Vector3 way = to - from;
  const bool cut = range.from_cut >= 0 || range.to_cut >= 0;
  if (cut && (range.to - range.from) * way.norm() <= 4.0 * slack) return {};
  return {true, from + range.from * way, from + range.to * way, range.from_cut, range.to_cut};
}

}  // namespace sinew::collision
