#include "sinew/collision/triangle_intersection.hpp"

#include <algorithm>

#include "sinew/collision/orientation.hpp"

namespace sinew::collision {

namespace {

// For segments in one plane, seen along an axis that is not in it.
bool segments_meet_in_plane(int axis, const Vector3& p, const Vector3& q, const Vector3& a,
                            const Vector3& b) {
  const int pa = orientation_along(axis, a, b, p), qa = orientation_along(axis, a, b, q);
  const int ap = orientation_along(axis, p, q, a), bp = orientation_along(axis, p, q, b);
  return pa * qa <= 0 && ap * bp <= 0;
}

bool boxes_meet(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b) {
  return (p.cwiseMin(q).array() <= a.cwiseMax(b).array()).all() &&
         (a.cwiseMin(b).array() <= p.cwiseMax(q).array()).all();
}

// Requires that the point lies in the triangle's plane and that the axis does not.
bool in_triangle(int axis, const Vector3& point, const Corners& t) {
  const int first = orientation_along(axis, t[0], t[1], point);
  const int second = orientation_along(axis, t[1], t[2], point);
  const int third = orientation_along(axis, t[2], t[0], point);
  return std::min({first, second, third}) >= 0 || std::max({first, second, third}) <= 0;
}

// An axis along which the triangle has an area; -1 if it is degenerate.
int seen_along(const Corners& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orientation_along(axis, t[0], t[1], t[2]) != 0) return axis;
  }
  return -1;
}

bool meets_border(const Vector3& p, const Vector3& q, const Corners& t) {
  return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) ||
         segments_meet(p, q, t[2], t[0]);
}

}  // namespace

bool segments_meet(const Vector3& p, const Vector3& q, const Vector3& a, const Vector3& b) {
  // The boxes decide collinear segments, which overlap exactly if their boxes do.
  if (!boxes_meet(p, q, a, b) || orientation(p, q, a, b) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool shows_area =
        orientation_along(axis, p, q, a) != 0 || orientation_along(axis, p, q, b) != 0 ||
        orientation_along(axis, a, b, p) != 0 || orientation_along(axis, a, b, q) != 0;
    if (shows_area) return segments_meet_in_plane(axis, p, q, a, b);
  }
  return true;
}

bool segment_meets_triangle(const Vector3& p, const Vector3& q, const Corners& t) {
  const int axis = seen_along(t);
  if (axis < 0) return meets_border(p, q, t);
  const int from = orientation(t[0], t[1], t[2], p), to = orientation(t[0], t[1], t[2], q);
  if (from * to > 0) return false;
  if (from == 0 && to == 0) return in_triangle(axis, p, t) || meets_border(p, q, t);
  const int first = orientation(p, q, t[0], t[1]), second = orientation(p, q, t[1], t[2]);
  const int third = orientation(p, q, t[2], t[0]);
  return std::min({first, second, third}) >= 0 || std::max({first, second, third}) <= 0;
}

bool triangles_meet(const Corners& first, const Corners& second) {
  const auto low = [](const Corners& t) { return t[0].cwiseMin(t[1]).cwiseMin(t[2]).eval(); };
  const auto high = [](const Corners& t) { return t[0].cwiseMax(t[1]).cwiseMax(t[2]).eval(); };
  if ((low(first).array() > high(second).array()).any() ||
      (low(second).array() > high(first).array()).any()) {
    return false;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (segment_meets_triangle(first[k], first[next], second) ||
        segment_meets_triangle(second[k], second[next], first)) {
      return true;
    }
  }
  return false;
}

}  // namespace sinew::collision
