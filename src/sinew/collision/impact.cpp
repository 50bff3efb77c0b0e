#include "sinew/collision/impact.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "sinew/collision/closest_points.hpp"
#include "sinew/collision/coplanarity.hpp"
#include "sinew/collision/relative_motion.hpp"

namespace sinew::collision {

namespace {

/// Number of planes after which a query counts as a meeting. A few suffice, except where points
/// turn about each other within `separation` and a thousandth of it, or stay in one plane.
constexpr int kMaxPlanes = 256;
/// Number of planes that are tried before the time of coplanarity is searched.
constexpr int kFirstPlanes = 2;

Vector3 to_nearest(const RelativeMotion& motion, double time, bool edges) {
  const Vector3 d0 = motion.at(0, time), d1 = motion.at(1, time), d2 = motion.at(2, time);
  if (!edges) return closest_on_triangle(Vector3::Zero(), d0, d1, d2).point;
  const OnEdges nearest = closest_on_edges(d0, d1, Vector3::Zero(), d0 - d2);
  return nearest.first_point - nearest.second_point;
}

// The direction between nearly touching points has no digits. These normals come from the edges:
// one normal to both, and one normal to each in their common plane.
double separated_by_edges(const RelativeMotion& motion, double time, bool edges) {
  const Vector3 d0 = motion.at(0, time), d1 = motion.at(1, time), d2 = motion.at(2, time);
  const Vector3 u = d1 - d0, v = d2 - d0, normal = u.cross(v);
  const Vector3 middle = edges ? (0.5 * (d1 + d2)).eval() : ((d0 + d1 + d2) / 3.0).eval();
  double until = time;
  const auto consider = [&](const Vector3& n) {
    until = std::max(until, motion.separated_until(n.dot(middle) < 0.0 ? (-n).eval() : n, time));
  };
  consider(normal);
  consider(u.cross(normal));
  consider(v.cross(normal));
  if (!edges) consider((v - u).cross(normal));
  return until;
}

std::optional<double> first_impact(const RelativeMotion& motion, const Coplanarity& coplanarity,
                                   bool edges) {
  double time = 0.0;
  for (int plane = 0; plane < kMaxPlanes; ++plane) {
    const double before = time;
    time = motion.separated_until(to_nearest(motion, time, edges), time);
    if (time > 1.0) return std::nullopt;
    if (plane < kFirstPlanes) continue;
    time = coplanarity.apart_until(time);
    if (time > 1.0) return std::nullopt;
    if (time > before) continue;
    time = separated_by_edges(motion, time, edges);
    if (time > 1.0) return std::nullopt;
    if (!(time > before)) break;
  }
  return time;
}

}  // namespace

std::optional<double> vertex_face_impact(const FourPoints& start, const FourPoints& end,
                                         double separation) {
  RelativeMotion motion(separation);
  for (int j = 0; j < 4; ++j) {
    const std::size_t corner = j < 3 ? static_cast<std::size_t>(j) + 1 : 3;
    motion.set(j, start[0] - start[corner], end[0] - end[corner]);
  }
  if (!motion.finite()) return 0.0;
  if (motion.apart_along_axis()) return std::nullopt;
  const Coplanarity coplanarity({start[0] - start[1], end[0] - end[1]},
                                {start[2] - start[1], end[2] - end[1]},
                                {start[3] - start[1], end[3] - end[1]}, separation);
  return first_impact(motion, coplanarity, false);
}

std::optional<double> edge_edge_impact(const FourPoints& start, const FourPoints& end,
                                       double separation) {
  RelativeMotion motion(separation);
  motion.set(0, start[0] - start[2], end[0] - end[2]);
  motion.set(1, start[1] - start[2], end[1] - end[2]);
  motion.set(2, start[0] - start[3], end[0] - end[3]);
  motion.set(3, start[1] - start[3], end[1] - end[3]);
  if (!motion.finite()) return 0.0;
  if (motion.apart_along_axis()) return std::nullopt;
  const Coplanarity coplanarity({start[0] - start[2], end[0] - end[2]},
                                {start[1] - start[0], end[1] - end[0]},
                                {start[3] - start[2], end[3] - end[2]}, separation);
  return first_impact(motion, coplanarity, true);
}

}  // namespace sinew::collision
