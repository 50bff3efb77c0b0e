#include "sinew/control/target.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::control {

namespace {

// Below this sine of the angle between x axis and normal, e1 is made from the y axis.
constexpr double kTooParallel = 0.42;

void require_positive(double value, const char* what, const char* unit) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    const auto kind = std::isfinite(value) ? ErrorKind::out_of_range : ErrorKind::not_finite;
    throw Error(kind, {}, fmt::format("{} is {} {}", what, value, unit), "it must be above 0");
  }
}

template <typename Derived>
void require_finite(const Eigen::DenseBase<Derived>& values, const char* what) {
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index j = 0; j < values.cols(); ++j) {
      if (!std::isfinite(values(i, j))) {
        throw Error(ErrorKind::not_finite, {}, fmt::format("{} holds {}", what, values(i, j)),
                    "every coordinate of a target must be finite");
      }
    }
  }
}

void require_points(const Points& points, const char* what) {
  if (points.rows() < 2) {
    throw Error(ErrorKind::too_few_points, {}, fmt::format("{} has {} points", what, points.rows()),
                "give at least two, or a fixed target");
  }
  require_finite(points, what);
}

}  // namespace

Target Target::fixed(const Vector3& position) {
  require_finite(position, "the target");
  return Target(Fixed{position});
}

Target Target::circle(const Circle& circle) {
  require_finite(circle.centre, "the circle's centre");
  require_finite(circle.normal, "the circle's normal");
  require_positive(circle.radius, "the circle's radius", "m");
  require_positive(circle.period, "the circle's period", "s");
  if (!std::isfinite(circle.start_angle)) {
    throw Error(ErrorKind::not_finite, {}, "the circle's start angle is not finite",
                "give an angle such as 90 deg");
  }
  require_positive(circle.normal.stableNorm(), "the length of the circle's normal", "");
  const Vector3 normal = circle.normal.stableNormalized();
  Vector3 start = Vector3::UnitX();
  if (normal.cross(start).norm() < kTooParallel) start = Vector3::UnitY();
  const Vector3 first = (start - normal.dot(start) * normal).normalized();
  return Target(Turn{circle.centre, circle.radius * first, circle.radius * normal.cross(first),
                     circle.period, circle.start_angle});
}

double Target::length(const Points& points, bool closed) {
  double sum = 0.0;
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    sum += (points.row(i) - points.row(i - 1)).stableNorm();
  }
  if (closed && points.rows() > 1) {
    sum += (points.row(0) - points.row(points.rows() - 1)).stableNorm();
  }
  return sum;
}

Target Target::polyline(const Polyline& polyline) {
  require_points(polyline.points, "the polyline");
  require_positive(polyline.period, "the polyline's period", "s");
  const double whole = length(polyline.points, polyline.closed);
  require_positive(whole, "the length of the polyline", "m");
  Path path;
  path.repeats = polyline.closed;
  const Eigen::Index given = polyline.points.rows();
  path.points.resize(given + (polyline.closed ? 1 : 0), 3);
  path.points.topRows(given) = polyline.points;
  if (polyline.closed) path.points.row(given) = polyline.points.row(0);
  double travelled = 0.0;
  path.times.push_back(0.0);
  for (Eigen::Index i = 1; i < path.points.rows(); ++i) {
    travelled += (path.points.row(i) - path.points.row(i - 1)).stableNorm();
    path.times.push_back(polyline.period * (travelled / whole));
  }
  return Target(std::move(path));
}

Target Target::trajectory(std::vector<double> times, Points positions) {
  require_points(positions, "the trajectory");
  if (static_cast<Eigen::Index>(times.size()) != positions.rows()) {
    throw Error(ErrorKind::wrong_length, {},
                fmt::format("{} times but {} positions", times.size(), positions.rows()),
                "give one position for each time");
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) {
      throw Error(ErrorKind::not_finite, {}, fmt::format("time {} is {}", i + 1, times[i]),
                  "times must be finite");
    }
    const double before = i > 0 ? times[i - 1] : 0.0;
    if (times[i] < before || (i > 0 && times[i] == before)) {
      throw Error(ErrorKind::non_monotonic_time, {},
                  fmt::format("time {} s (sample {}) follows {} s", times[i], i + 1, before),
                  "times must start at 0 s or later and increase");
    }
  }
  return Target(Path{std::move(times), std::move(positions), false});
}

Vector3 Target::Path::at(double time) const {
  const double period = times.back();
  double now = time;
  if (repeats) {
    now = std::fmod(time, period);
    if (now < 0.0) now += period;
  }
  // The first segment that ends after `now`: zero-length segments of repeated points are skipped.
  const auto after = std::upper_bound(times.begin(), times.end(), now);
  if (after == times.begin()) return points.row(0).transpose();
  if (after == times.end()) return points.row(points.rows() - 1).transpose();
  const auto last = static_cast<Eigen::Index>(after - times.begin()) - 1;
  const double begin = times[static_cast<std::size_t>(last)];
  const double share = (now - begin) / (*after - begin);
  return ((1.0 - share) * points.row(last) + share * points.row(last + 1)).transpose();
}

Vector3 Target::at(double time) const {
  if (const auto* fixed = std::get_if<Fixed>(&form_)) return fixed->position;
  if (const auto* turn = std::get_if<Turn>(&form_)) {
    const double angle = turn->start_angle + 2.0 * std::numbers::pi * time / turn->period;
    return turn->centre + std::cos(angle) * turn->first + std::sin(angle) * turn->second;
  }
  return std::get<Path>(form_).at(time);
}

double Target::farthest_from(const Vector3& point) const {
  if (const auto* fixed = std::get_if<Fixed>(&form_)) return (fixed->position - point).stableNorm();
  if (const auto* turn = std::get_if<Turn>(&form_)) {
    return (turn->centre - point).stableNorm() + turn->first.stableNorm();
  }
  double farthest = 0.0;
  const auto& points = std::get<Path>(form_).points;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    farthest = std::max(farthest, (points.row(i).transpose() - point).stableNorm());
  }
  return farthest;
}

double Target::end_time() const {
  if (const auto* turn = std::get_if<Turn>(&form_)) return turn->period;
  if (const auto* path = std::get_if<Path>(&form_)) return path->times.back();
  return 0.0;
}

}  // namespace sinew::control
