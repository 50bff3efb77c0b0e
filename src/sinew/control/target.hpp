/// @file
/// Target of an effector over time: a fixed position, or a path travelled at constant speed.
#pragma once

#include <utility>
#include <variant>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::control {

/// A circle: centre + radius (cos(a) e1 + sin(a) e2), a = start_angle + 2 pi t / period,
/// counter-clockwise about `normal`. e1 is the projection of the world's x axis normal to `normal`
/// (of its y axis if x is within 25 degrees of `normal`); e2 = normal x e1.
struct Circle {
  Vector3 centre = Vector3::Zero();   ///< m
  double radius = 0.0;                ///< m, > 0
  Vector3 normal = Vector3::UnitZ();  ///< of any length above zero
  double period = 1.0;                ///< s per turn, > 0
  double start_angle = 0.0;           ///< rad
};

/// Straight lines through `points` at constant speed. An open path is travelled once and ends at
/// its last point; a closed one returns to its first point and repeats for ever.
struct Polyline {
  Points points;        ///< (n, 3) m, n >= 2
  double period = 0.0;  ///< s for the whole path once, > 0
  bool closed = false;  ///< adds the line from the last point to the first
};

/// A position over time. Immutable; reading it allocates nothing and is thread-safe. For an
/// orientation effector, the three numbers are a rotation vector (rad) instead.
class Target {
 public:
  /// The origin for ever.
  Target() : form_(Fixed{Vector3::Zero()}) {}

  /// A constant position. Throws Error: not-finite.
  static Target fixed(const Vector3& position);
  /// A circle. Throws Error: out-of-range for a radius or period that is not positive or a zero
  /// normal, not-finite.
  static Target circle(const Circle& circle);
  /// A polyline. Throws Error: too-few-points for fewer than two points, out-of-range for a period
  /// that is not positive or a path of zero length, not-finite. Repeated points are allowed.
  static Target polyline(const Polyline& polyline);
  /// Straight lines between samples. Before the first sample and after the last one, their
  /// positions are held.
  /// @param times (n,) s, increasing, >= 0.
  /// @param positions (n, 3) m.
  /// Throws Error: too-few-points, wrong-length, non-monotonic-time, not-finite.
  static Target trajectory(std::vector<double> times, Points positions);

  /// Length of a polyline (m), including the closing line: period = length / speed.
  static double length(const Points& points, bool closed);

  /// The position at `time` (s): (3,) m.
  Vector3 at(double time) const;

  /// Largest distance (m) of the target from a point, (3,) m, over all time; an upper bound for a
  /// circle.
  double farthest_from(const Vector3& point) const;

  /// Time at which the target has completed its path (s): 0 if fixed, one turn of a circle or
  /// closed polyline, the end of an open polyline or trajectory.
  double end_time() const;

 private:
  struct Fixed {
    Vector3 position = Vector3::Zero();
  };
  struct Turn {
    Vector3 centre, first, second;  ///< m; first and second are the radius times e1 and e2
    double period = 1.0, start_angle = 0.0;
  };
  struct Path {
    std::vector<double> times;  ///< (n,) s when each point is reached
    Points points;              ///< (n, 3) m
    bool repeats = false;
    Vector3 at(double time) const;
  };
  using Form = std::variant<Fixed, Turn, Path>;

  explicit Target(Form form) : form_(std::move(form)) {}

  Form form_;
};

}  // namespace sinew::control
