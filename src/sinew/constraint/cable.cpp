#include "sinew/constraint/cable.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::constraint {

namespace {

// Under this length (m) a segment has no direction; a robot's via points are far apart from it.
constexpr double kShortestSegment = 1e-12;

struct Segment {
  Vector3 direction = Vector3::Zero();
  double length = 0.0;
};

Segment segment(const Vector3& from, const Vector3& to) {
  Segment result;
  const Vector3 step = to - from;
  result.length = step.norm();
  if (result.length > kShortestSegment) result.direction = step / result.length;
  return result;
}

}  // namespace

Cable::Cable(std::string name, std::vector<mechanics::MaterialPoint> points,
             std::optional<Vector3> world_pull_point, const Points& placement_at_rest)
    : Constraint(std::move(name)),
      points_(std::move(points)),
      pull_point_(std::move(world_pull_point)) {
  if (point_count() < 2) {
    throw Error(ErrorKind::too_few_points, {.item = "cable '" + this->name() + "'"},
                fmt::format("a cable needs at least two points, got {}", point_count()),
                "give the pull point and every via point");
  }
  const Vector3 extent =
      placement_at_rest.colwise().maxCoeff() - placement_at_rest.colwise().minCoeff();
  const double shortest = std::max(1e-6 * extent.norm(), kShortestSegment);
  for (int i = 0; i + 1 < point_count(); ++i) {
    const Vector3 a = placement_at_rest.row(i);
    const Vector3 b = placement_at_rest.row(i + 1);
    const double length = (b - a).norm();
    if (length < shortest) {
      throw Error(ErrorKind::degenerate_cable, {.item = "cable '" + this->name() + "'"},
                  fmt::format("points {} and {} coincide at ({:g}, {:g}, {:g}) m", i, i + 1, a.x(),
                              a.y(), a.z()),
                  "remove one of them");
    }
    rest_length_ += length;
  }
}

Vector3 Cable::point(const Placement& placement, int i) const {
  if (!pull_point_) return placement.position(points_[static_cast<std::size_t>(i)]);
  return i == 0 ? *pull_point_ : placement.position(points_[static_cast<std::size_t>(i - 1)]);
}

void Cable::declare(mechanics::RowPattern& rows, std::vector<mechanics::RowCurvature>& curvatures) {
  first_entry_ = rows.entries();
  first_row_ = rows.add_row(points_);
  row_count_ = 1;
  first_curvature_ = static_cast<int>(curvatures.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    curvatures.push_back({first_row_, points_[i], points_[i], Matrix3::Zero()});
    if (i + 1 < points_.size()) {
      curvatures.push_back({first_row_, points_[i], points_[i + 1], Matrix3::Zero()});
    }
  }
  curvature_count_ = static_cast<int>(curvatures.size()) - first_curvature_;
}

void Cable::linearise(const Placement& placement, mechanics::RowValues& values) const {
  const int count = point_count();
  const int skip = pull_point_ ? 1 : 0;
  Vector3 before = Vector3::Zero();
  Vector3 here = point(placement, 0);
  double length = 0.0;
  for (int i = 0; i < count; ++i) {
    Segment next;
    if (i + 1 < count) {
      const Vector3 there = point(placement, i + 1);
      next = segment(here, there);
      here = there;
    }
    if (i >= skip) {
      values.direction[static_cast<std::size_t>(first_entry_ + i - skip)] = next.direction - before;
    }
    length += next.length;
    before = next.direction;
  }
  values.delta[first_row_] = rest_length_ - length;
}

void Cable::curve(const Placement& placement, std::span<mechanics::RowCurvature> curvatures) const {
  const int skip = pull_point_ ? 1 : 0;
  for (auto& entry : curvatures) entry.curvature.setZero();
  // Diagonal pairs of sliding point k stand at 2 k, its pair with the next one at 2 k + 1.
  for (int i = 0; i + 1 < point_count(); ++i) {
    const Segment s = segment(point(placement, i), point(placement, i + 1));
    if (s.length <= kShortestSegment) continue;
    const Matrix3 bend = (Matrix3::Identity() - s.direction * s.direction.transpose()) / s.length;
    const int k = i - skip;
    if (k >= 0) {
      curvatures[static_cast<std::size_t>(2 * k)].curvature -= bend;
      curvatures[static_cast<std::size_t>(2 * k + 1)].curvature += bend;
    }
    curvatures[static_cast<std::size_t>(2 * (k + 1))].curvature -= bend;
  }
}

double Cable::length(const Placement& placement) const {
  double length = 0.0;
  for (int i = 0; i + 1 < point_count(); ++i) {
    length += segment(point(placement, i), point(placement, i + 1)).length;
  }
  return length;
}

double Cable::wrap(const Placement& placement) const {
  double angle = 0.0;
  for (int i = 1; i + 1 < point_count(); ++i) {
    const Vector3 a = segment(point(placement, i - 1), point(placement, i)).direction;
    const Vector3 b = segment(point(placement, i), point(placement, i + 1)).direction;
    angle += std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return angle;
}

Points Cable::points(const Placement& placement) const {
  Points result(point_count(), 3);
  for (int i = 0; i < point_count(); ++i) result.row(i) = point(placement, i);
  return result;
}

}  // namespace sinew::constraint
