/// @file
/// The points at which rigid bodies strike.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/constraint/contact.hpp"
#include "sinew/sim/touching_surfaces.hpp"

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
  /// bodies touch. @param time s. @param effort (rows,) N of the last part, see
  /// World::begin_look().
  void look(double time, std::span<double> effort);
  /// Whether a closed point approaches.
  bool strike() const;
  /// (rows,) at normals: 0 at points that are to rest.
  std::span<const double> restitution() const { return restitution_; }
  /// Marks the points that are closed for the next part: those that also rest.
  void close();

  /// After a part was made: the length up to which no gap closes, or `length`. Of surfaces, gaps
  /// are looked at anew at the end of the part, and continuous detection tells what they passed.
  /// @param length s, of the part. @param parts that the step had so far: after many, shorter ones
  /// are not made, and what closes in them overlaps a little.
  double free_length(double length, int parts);
  /// s: when the next part ends at the latest: at the next corner of a motion that carries what may
  /// strike. It is struck there by a change of its velocity. @param time s, now.
  double next_corner(double time) const;
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
    int contact = -1;        // of the model
    std::size_t number = 0;  // of the contact's
    int row = -1;            // of its normal
    constraint::Friction friction;
    double gap = 0.0;       // m
    double velocity = 0.0;  // m/s, of the gap
    double slip = 0.0;      // m/s
    double speed = 0.0;     // m/s, of the body
  };

  // A point by what it is called, as another look finds it again.
  struct Named {
    int contact = -1;
    TouchingSurfaces::Key key;
    bool operator==(const Named&) const = default;
  };
  Named name(const Point& point) const;
  bool rests(const Point& point) const;

  bool is_closed(const Point& point) const;
  void look_at(int contact);
  Point measure(int contact, std::size_t number) const;
  double gap_at_end(const Point& point) const;
  double closing_time(const Point& point, double end, double length);
  double unseen_length(double length);
  double deepest(double time) const;

  const Model& model_;
  World& world_;
  std::vector<int> contacts_;        // that strike
  std::vector<Point> points_;        // that may touch, of all of them
  std::vector<double> restitution_;  // (rows,)
  std::vector<Named> rests_;         // points that are to rest
  double closed_ = 0.0;              // m: lesser gaps are closed
  double still_ = 0.0;               // m/s: lesser velocities are none
  double shortest_ = 0.0;            // s, of parts
  double deepest_ = 0.0;             // m, when the part began
  double time_ = 0.0;                // s, likewise
  bool found_rest_ = false;
};

}  // namespace sinew::sim
