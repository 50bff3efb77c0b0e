#include "sinew/constraint/cable.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/core/error.hpp"

namespace sinew::constraint {

namespace {

// Below this length (m) a segment has no direction; via points of a robot are much farther apart.
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
             std::optional<Vector3> world_pull_point, const Points& points_at_rest, bool friction)
    : Constraint(std::move(name)),
      points_(std::move(points)),
      pull_point_(std::move(world_pull_point)),
      friction_(friction) {
  if (point_count() < 2) {
    throw Error(ErrorKind::too_few_points, {.item = "cable '" + this->name() + "'"},
                fmt::format("a cable needs at least two points, got {}", point_count()),
                "give the pull point and every via point");
  }
  const Vector3 extent = points_at_rest.colwise().maxCoeff() - points_at_rest.colwise().minCoeff();
  const double shortest = std::max(1e-6 * extent.norm(), kShortestSegment);
  for (int i = 0; i + 1 < point_count(); ++i) {
    const Vector3 a = points_at_rest.row(i);
    const Vector3 b = points_at_rest.row(i + 1);
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

Vector3 Cable::point(const Configuration& configuration, int i) const {
  if (!pull_point_) return configuration.position(points_[static_cast<std::size_t>(i)]);
  return i == 0 ? *pull_point_ : configuration.position(points_[static_cast<std::size_t>(i - 1)]);
}

void Cable::declare(mechanics::RowPattern& rows,
                    std::vector<mechanics::StiffnessPair>& stiffness_pairs) {
  first_entry_ = rows.entries();
  first_row_ = rows.add_row(points_);
  row_count_ = 1;
  const int skip = pull_point_ ? 1 : 0;
  for (int via = 0; friction_ && via < via_count(); ++via, ++row_count_) {
    rows.add_row(std::span(points_).subspan(static_cast<std::size_t>(via + 1 - skip)));
  }
  first_stiffness_pair_ = static_cast<int>(stiffness_pairs.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    stiffness_pairs.push_back({points_[i], points_[i], Matrix3::Zero()});
    if (i + 1 < points_.size()) {
      stiffness_pairs.push_back({points_[i], points_[i + 1], Matrix3::Zero()});
    }
  }
  stiffness_pair_count_ = static_cast<int>(stiffness_pairs.size()) - first_stiffness_pair_;
}

void Cable::linearise(const Configuration& configuration, mechanics::RowValues& values) const {
  const int count = point_count();
  const int skip = pull_point_ ? 1 : 0;
  Vector3 before = Vector3::Zero();
  Vector3 here = point(configuration, 0);
  double length = 0.0;
  for (int i = 0; i < count; ++i) {
    Segment next;
    if (i + 1 < count) {
      const Vector3 there = point(configuration, i + 1);
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
  if (friction_) linearise_friction(configuration, values);
}

// Row of via point i: minus the directions of the pull row at all points behind it; at the point
// itself only the segment behind it counts. Its motion is the length behind the point, not its
// change from rest, since laws use differences only.
void Cable::linearise_friction(const Configuration& configuration,
                               mechanics::RowValues& values) const {
  const int skip = pull_point_ ? 1 : 0;
  const int count = point_count();
  auto entry = static_cast<std::size_t>(first_entry_) + points_.size();
  for (int via = 0; via < via_count(); ++via) {
    const int first = via + 1;
    const Segment behind = segment(point(configuration, first), point(configuration, first + 1));
    values.direction[entry++] = -behind.direction;
    for (int i = first + 1; i < count; ++i) {
      values.direction[entry++] =
          -values.direction[static_cast<std::size_t>(first_entry_ + i - skip)];
    }
  }
  double length = 0.0;  // behind the point
  for (int via = via_count(); via-- > 0;) {
    length += segment(point(configuration, via + 1), point(configuration, via + 2)).length;
    values.delta[friction_row(via)] = length;
  }
}

void Cable::geometric_stiffness(const Configuration& configuration, std::span<const double> effort,
                                std::span<mechanics::StiffnessPair> stiffness_pairs) const {
  const int skip = pull_point_ ? 1 : 0;
  for (auto& entry : stiffness_pairs) entry.hessian.setZero();
  const double* lambda = effort.data() + first_row_;
  double tension = lambda[0];
  // The diagonal pair of sliding point k has index 2 k, its pair with the next point 2 k + 1.
  for (int i = 0; i + 1 < point_count(); ++i) {
    if (friction_ && i > 0) tension -= lambda[i];
    const Segment s = segment(point(configuration, i), point(configuration, i + 1));
    if (s.length <= kShortestSegment) continue;
    const Matrix3 bend =
        tension * (Matrix3::Identity() - s.direction * s.direction.transpose()) / s.length;
    const int k = i - skip;
    if (k >= 0) {
      stiffness_pairs[static_cast<std::size_t>(2 * k)].hessian -= bend;
      stiffness_pairs[static_cast<std::size_t>(2 * k + 1)].hessian += bend;
    }
    stiffness_pairs[static_cast<std::size_t>(2 * (k + 1))].hessian -= bend;
  }
}

double Cable::length(const Configuration& configuration) const {
  double length = 0.0;
  for (int i = 0; i + 1 < point_count(); ++i) {
    length += segment(point(configuration, i), point(configuration, i + 1)).length;
  }
  return length;
}

double Cable::turn(const Configuration& configuration, int via) const {
  const Vector3 here = point(configuration, via + 1);
  const Vector3 a = segment(point(configuration, via), here).direction;
  const Vector3 b = segment(here, point(configuration, via + 2)).direction;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double Cable::wrap(const Configuration& configuration) const {
  double angle = 0.0;
  for (int via = 0; via < via_count(); ++via) angle += turn(configuration, via);
  return angle;
}

bool Cable::stiffens(std::span<const double> effort) const {
  double tension = effort[static_cast<std::size_t>(first_row_)];
  bool taut = tension >= 0.0;
  for (int via = 0; friction_ && via < via_count(); ++via) {
    tension -= effort[static_cast<std::size_t>(friction_row(via))];
    taut = taut && tension >= 0.0;
  }
  return taut;
}

std::vector<double> Cable::tensions(std::span<const double> effort) const {
  std::vector<double> result{effort[static_cast<std::size_t>(first_row_)]};
  for (int via = 0; via < via_count(); ++via) {
    const double lost = friction_ ? effort[static_cast<std::size_t>(friction_row(via))] : 0.0;
    result.push_back(result.back() - lost);
  }
  return result;
}

Points Cable::points(const Configuration& configuration) const {
  Points result(point_count(), 3);
  for (int i = 0; i < point_count(); ++i) result.row(i) = point(configuration, i);
  return result;
}

}  // namespace sinew::constraint
