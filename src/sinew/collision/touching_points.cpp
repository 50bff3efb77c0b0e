#include "sinew/collision/touching_points.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/collision/closest_points.hpp"
#include "sinew/collision/facet_pair.hpp"
#include "sinew/collision/separation.hpp"
#include "sinew/collision/touching_candidates.hpp"

namespace sinew::collision {

namespace {

bool has_side(const SymmetricSolid& solid) {
  return solid.half_size[2] > 0.0 && !(solid.half_size[0] > 0.0);
}

// Adds the ends of a round side next to another one, for the contact of two that lie along each
// other: the point of the end that faces the other axis, and its nearest point of the other shape.
// @param round is the first of the pair if `is_first`.
void add_ends(const SymmetricSolid& round, const SymmetricSolid& other, const Shape& other_shape,
              bool is_first, TouchingCandidates& candidates) {
  constexpr double kFacing = 0.5;  // sine: an end turned towards the other touches with its face
  for (int side = 0; side < 2; ++side) {
    const Vector3 end = round.end(side);
    const OnEdge foot = closest_on_edge(end, other.end(0), other.end(1));
    if (!(foot.share > 0.0 && foot.share < 1.0)) continue;
    const Vector3 towards = foot.point - end;
    const Vector3 across = round.axis().cross(towards).cross(round.axis());
    const double length = across.norm();
    if (!(length > kFacing * towards.norm() && length > candidates.same())) continue;
    const ShapeDistance at = distance(other_shape, end + round.rim / length * across);
    const Vector3 own = at.nearest + (at.gap - round.radius) * at.normal;
    if (is_first) {
      candidates.add(own, at.nearest, at.normal, feature_of(part::side_end(side), part::kInside));
    } else {
      candidates.add(at.nearest, own, -at.normal, feature_of(part::kInside, part::side_end(side)));
    }
  }
}

void clip_all(const Facets& first, const Facets& second, const Vector3& normal,
              TouchingCandidates& candidates) {
  for (const Facet& a : first) {
    for (const Facet& b : second) FacetPair(a, b, normal, candidates).clip_both();
  }
}

TouchingPoints of_bounded(const Shape& first_shape, const Shape& second_shape, double margin) {
  const SymmetricSolid first = symmetric_solid(first_shape), second = symmetric_solid(second_shape);
  const Separation apart = separation(first, second, margin);
  if (!(apart.gap <= margin)) return {};
  TouchingCandidates candidates(first.reach() + second.reach(), apart.gap, margin);
  clip_all(Facets(first, -apart.normal), Facets(second, apart.normal), apart.normal, candidates);
  if (has_side(first) && has_side(second)) {
    add_ends(first, second, second_shape, true, candidates);
    add_ends(second, first, first_shape, false, candidates);
  }
  candidates.add_nearest(apart);
  return candidates.reduced();
}

// The solid is the first shape.
TouchingPoints on_plane(const SymmetricSolid& solid, const Plane& plane, double margin) {
  const Vector3& normal = plane.normal;
  const Vector3 lowest = solid.core_support(-normal) - solid.radius * normal;
  const double gap = normal.dot(lowest - plane.point);
  TouchingCandidates candidates(solid.reach(), gap, margin);
  clip_all(Facets(solid, -normal), Facets(plane), normal, candidates);
  candidates.add_nearest({normal, gap, lowest, lowest - gap * normal});
  return candidates.reduced();
}

// The corners of a polyhedron above a plane.
class CornersOnPlane {
 public:
  CornersOnPlane(const ConvexSolid& solid, const Plane& plane, double margin)
      : solid_(solid), plane_(plane), margin_(margin) {}

  std::size_t size() const { return solid_.hull->corners().size(); }
  Vector3 at(std::size_t k) const {
    return solid_.origin + solid_.axes * solid_.hull->corners()[k];
  }
  double gap(std::size_t k) const { return plane_.normal.dot(at(k) - plane_.point); }
  bool is_near(std::size_t k) const { return gap(k) <= margin_; }
  void add(std::size_t k, TouchingCandidates& candidates) const {
    candidates.add(at(k), at(k) - gap(k) * plane_.normal, plane_.normal, 1 + static_cast<int>(k));
  }
  // Index of the near corner that is farthest in a direction, or size().
  std::size_t farthest(const Vector3& direction) const {
    std::size_t best = size();
    double most = -kInfinity;
    for (std::size_t k = 0; k < size(); ++k) {
      const double far = direction.dot(at(k) - solid_.origin);
      if (!(far > most) || !is_near(k)) continue;
      best = k;
      most = far;
    }
    return best;
  }

 private:
  const ConvexSolid& solid_;
  const Plane& plane_;
  double margin_;
};

// Takes all near corners; if there are many, those that are farthest in directions along the plane
// and slightly or steeply down, so that no upper corner replaces the lower ones.
TouchingPoints on_plane(const ConvexSolid& solid, const Plane& plane, double margin) {
  constexpr int kDirections = 32;
  const CornersOnPlane corners(solid, plane, margin);
  const std::size_t lowest = corners.farthest(-plane.normal);
  if (lowest == corners.size()) return {};
  TouchingCandidates candidates(2.0 * solid.hull->reach(), corners.gap(lowest), margin);
  corners.add(lowest, candidates);
  std::size_t near = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) near += corners.is_near(k) ? 1 : 0;
  for (std::size_t k = 0; k < corners.size() && near <= TouchingPoints::kMax; ++k) {
    corners.add(k, candidates);
  }
  if (near <= TouchingPoints::kMax) return candidates.reduced();
  const Vector3 u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
  for (int d = 0; d < kDirections; ++d) {
    const double angle = 2.0 * std::numbers::pi * d / kDirections;
    const Vector3 way = std::cos(angle) * u + std::sin(angle) * v;
    for (const double down : {0.2, 1.0}) {
      corners.add(corners.farthest(way - down * plane.normal), candidates);
    }
  }
  return candidates.reduced();
}

TouchingPoints on_plane(const Shape& shape, const Plane& plane, double margin) {
  if (const auto* solid = std::get_if<ConvexSolid>(&shape)) return on_plane(*solid, plane, margin);
  return on_plane(symmetric_solid(shape), plane, margin);
}

TouchingPoints swapped(const TouchingPoints& points) {
  TouchingPoints other;
  for (const TouchingPoint& at : points) {
    other.add({at.on_second, at.on_first, -at.normal, at.gap, at.feature});
  }
  return other;
}

}  // namespace

TouchingPoints touching_points(const Shape& first, const Shape& second, double margin) {
  const Plane *below = std::get_if<Plane>(&second), *above = std::get_if<Plane>(&first);
  if (below && above) return {};
  if (below) return on_plane(first, *below, margin);
  if (above) return swapped(on_plane(second, *above, margin));
  return of_bounded(first, second, margin);
}

}  // namespace sinew::collision
