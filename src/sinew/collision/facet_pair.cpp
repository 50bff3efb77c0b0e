#include "sinew/collision/facet_pair.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace sinew::collision {

namespace {

// First numbers of the kinds of points on a rim.
constexpr int kCut = 0, kCrossing = 4, kAround = 8, kLowest = 12;

bool is_disc(const Facet& facet) { return facet.kind == Facet::Kind::disc; }

// The part of a facet that cuts a segment: a side, or a corner where rounding would choose the
// side.
// @param at (3,) m, on the facet. @param near m. @param cut see Clipped.
// @param end 0 or 1, of the segment.
int cutting_part(const Facet& facet, const Vector3& at, double near, int cut, int end) {
  if (cut < 0) return part::kInside;
  if (is_disc(facet)) return part::rim(facet.end, kCut + end);
  const auto k = static_cast<std::size_t>(cut);
  const std::size_t next = (k + 1) % facet.corner_count;
  int a = facet.names[k], b = facet.names[next];
  if ((facet.corners[k] - at).norm() <= near) b = a;
  if ((facet.corners[next] - at).norm() <= near) a = b;
  return part::edge(a, b);
}

}  // namespace

void FacetPair::clip_both() {
  if (second_.flat()) clip_border(first_, second_, true);
  if (first_.flat()) clip_border(second_, first_, false);
  if (is_disc(first_) && second_.flat()) rim_points(first_, second_, true);
  if (is_disc(second_) && first_.flat()) rim_points(second_, first_, false);
  if (!is_disc(first_) || !is_disc(second_)) return;
  rim_crossings(first_, second_, true);
  rim_crossings(second_, first_, false);
}

void FacetPair::add(const Vector3& point, int own_part, const Facet& other, int other_part,
                    bool is_first) {
  const Vector3 opposite = other.cast(point, normal_);
  if (is_first) {
    candidates_.add(point, opposite, normal_, feature_of(own_part, other_part));
  } else {
    candidates_.add(opposite, point, normal_, feature_of(other_part, own_part));
  }
}

void FacetPair::add_if_over(const Vector3& point, int own_part, const Facet& other, bool is_first) {
  if (!clip(point, point, other, normal_, candidates_.same()).any) return;
  const bool face = other.kind == Facet::Kind::polygon;
  add(point, own_part, other, face ? part::face(other.face) : part::kInside, is_first);
}

void FacetPair::clip_border(const Facet& own, const Facet& other, bool is_first) {
  const double near = 10.0 * candidates_.same();
  const std::size_t edges = own.corner_count == 2 ? 1 : own.corner_count;
  for (std::size_t k = 0; k < edges; ++k) {
    const std::size_t next = (k + 1) % own.corner_count;
    const auto add_end = [&](const Vector3& at, int cut, int end) {
      const int here = own.names[end == 0 ? k : next], there = own.names[end == 0 ? next : k];
      add(at, part::edge(here, cut < 0 ? here : there), other,
          cutting_part(other, other.cast(at, normal_), near, cut, end), is_first);
    };
    const Clipped kept =
        clip(own.corners[k], own.corners[next], other, normal_, candidates_.same());
    if (!kept.any) continue;
    add_end(kept.from, kept.from_cut, 0);
    add_end(kept.to, kept.to_cut, 1);
  }
}

// Adds four points of a rim, in directions that do not turn with noise in the disc's pose, and the
// point with the smallest gap, which is well defined if the gaps differ.
void FacetPair::rim_points(const Facet& disc, const Facet& other, bool is_first) {
  const Vector3 v = across_rim(disc, other), u = v.cross(disc.normal);
  const std::array<Vector3, 4> ways = {u, v, -u, -v};
  for (std::size_t k = 0; k < 4; ++k) {
    add_if_over(disc.centre + disc.radius * ways[k],
                part::rim(disc.end, kAround + static_cast<int>(k)), other, is_first);
  }
  constexpr double kLevel = 1e-9;  // sine
  const double side = is_first ? 1.0 : -1.0;
  const Vector3 rise = side * other.normal / other.normal.dot(normal_);
  const Vector3 across = disc.normal.cross(rise).cross(disc.normal);
  if (across.norm() <= kLevel) return;
  add_if_over(disc.centre - disc.radius * across.normalized(), part::rim(disc.end, kLowest), other,
              is_first);
}

// A direction in the plane of a disc, normal to a polygon's side.
Vector3 FacetPair::across_rim(const Facet& disc, const Facet& other) const {
  if (other.kind != Facet::Kind::polygon) {
    return disc.normal.cross(normal_.unitOrthogonal()).normalized();
  }
  const Vector3 a = disc.normal.cross((other.corners[1] - other.corners[0]).normalized());
  const Vector3 b = disc.normal.cross((other.corners[2] - other.corners[1]).normalized());
  return (a.squaredNorm() > 0.25 ? a : b).normalized();
}

// Adds the crossings of two rims, seen along the normal, by bisection between points that separate
// them. The first of these points lies towards the other centre, so that two intervals would
// suffice for parallel discs; inclined discs have up to four crossings.
void FacetPair::rim_crossings(const Facet& disc, const Facet& other, bool is_first) {
  constexpr int kParts = 16;
  constexpr double kPart = 2.0 * std::numbers::pi / kParts;
  const Vector3 towards = disc.cast(other.centre, normal_) - disc.centre;
  const double apart = towards.norm();
  if (apart <= candidates_.same()) return;
  const Vector3 u = towards / apart, v = disc.normal.cross(u);
  const auto at = [&](double angle) -> Vector3 {
    return disc.centre + disc.radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  const auto inside = [&](double angle) {
    return (other.cast(at(angle), normal_) - other.centre).norm() < other.radius;
  };
  int found = 0;
  for (int k = 0; k < kParts && found < 4; ++k) {
    double low = k * kPart, high = (k + 1) * kPart;
    const bool starts_inside = inside(low);
    if (starts_inside == inside(high)) continue;
    for (int halving = 0; halving < 50; ++halving) {
      const double middle = 0.5 * (low + high);
      (inside(middle) == starts_inside ? low : high) = middle;
    }
    add(at(low), part::rim(disc.end, kCrossing + found++), other, part::kInside, is_first);
  }
}

}  // namespace sinew::collision
