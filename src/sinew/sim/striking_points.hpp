/// @file
/// The points at which rigid bodies strike.
#pragma once

#include <span>
#include <vector>

#include "sinew/constraint/contact.hpp"

namespace sinew::sim {

class Model;
class World;

/// Of contacts that strike (ContactRows): gaps and velocities when a part of a step begins, which
/// points are closed, and when the next gap closes.
class StrikingPoints {
 public:
  /// Both outlive it.
  StrikingPoints(const Model& model, World& world);

  /// Takes up the present state, and marks the points that are closed for an impact: all whose
  /// bodies touch. @param time s.
  void look(double time);
  /// Whether a closed point approaches.
  bool strike() const;
  /// (rows,) at normals: 0 at points that are to rest.
  std::span<const double> restitution() const { return restitution_; }
  /// Marks the points that are closed for the next part: those that also rest.
  void close();

  /// After a part was made: the length up to which no gap closes, or `length`.
  /// @param length s, of the part.
  double free_length(double length);
  /// Whether free_length() found rebounds too small to be made: their points are to rest.
  bool found_rest() const { return found_rest_; }
  /// Rebounds may be made again.
  void forget_rest();
  /// Whether a closed point that is pressed has a velocity along its normal now.
  /// @param effort (rows,) N.
  bool drift(std::span<const double> effort) const;
  /// Whether a closed point has just stopped to slide. @param effort (rows,) N.
  bool caught(std::span<const double> effort) const;

 private:
  struct Point {
    int row = -1;  // of its normal
    constraint::Friction friction;
    double gap = 0.0;       // m
    double velocity = 0.0;  // m/s, of the gap
    double slip = 0.0;      // m/s
    double speed = 0.0;     // m/s, of the body
  };

  double closing_time(const Point& point, double end, double length);
  double deepest() const;

  const Model& model_;
  World& world_;
  std::vector<int> contacts_;        // that strike
  std::vector<Point> points_;        // that may touch, of all of them
  std::vector<double> restitution_;  // (rows,)
  std::vector<char> rests_;          // (rows,)
  double closed_ = 0.0;              // m: lesser gaps are closed
  double still_ = 0.0;               // m/s: lesser velocities are none
  double deepest_ = 0.0;             // m, when the part began
  double time_ = 0.0;                // s, likewise
  bool found_rest_ = false;
};

}  // namespace sinew::sim
