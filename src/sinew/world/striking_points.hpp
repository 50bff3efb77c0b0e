/// @file
/// Contact points at which rigid bodies strike.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/constraint/contact.hpp"
#include "sinew/contact/touching_surfaces.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::world {

class World;

/// Points of contacts that strike (ContactRows): their gaps and velocities at the start of a part
/// of a step, which of them are closed, and when the next gap closes.
class StrikingPoints {
 public:
  /// Both must outlive it.
  StrikingPoints(const model::Model& model, World& world);

  /// Measures the present state, and marks all points with closed gaps as closed, for an impact.
  /// @param time s. @param effort (rows,) N of the last part, see World::begin_event_query().
  void look(double time, std::span<double> effort);
  /// Whether the gap of a closed point decreases.
  bool strike() const;
  /// (rows,) coefficients of restitution at normal rows; 0 at points that must come to rest.
  std::span<const double> restitution() const { return restitution_; }
  /// Marks the points that are closed in the next part: those with closed gaps that also rest.
  void close();

  /// After a part was made: the length up to which no gap closes, or `length`. For surfaces, gaps
  /// are measured again at the end of the part, and continuous collision detection finds passages
  /// between unobserved features.
  /// @param length s, of the part.
  /// @param parts number of parts of the step so far; after many, the minimum length grows, and
  ///   gaps that close within it overlap slightly.
  double free_length(double length, int parts);
  /// s: the latest end of the next part: the next corner of a prescribed motion of anything that
  /// may strike, where a jump of its velocity can cause an impact. @param time s, present.
  double next_corner(double time) const;
  /// Whether free_length() found rebounds that are too small: their points must come to rest.
  bool found_rest() const { return found_rest_; }
  /// Permits rebounds of these points again.
  void forget_rest();
  /// Whether a closed point with a force has a velocity along its normal.
  /// @param effort (rows,) N.
  bool drift(std::span<const double> effort) const;
  /// Whether a closed point has just stopped sliding. @param effort (rows,) N.
  bool caught(std::span<const double> effort) const;

 private:
  struct Point {
    int contact = -1;        // index in the model
    std::size_t number = 0;  // index in the contact
    int row = -1;            // of its normal
    constraint::Friction friction;
    double gap = 0.0;       // m
    double velocity = 0.0;  // m/s, rate of the gap
    double slip = 0.0;      // m/s
    double speed = 0.0;     // m/s, of the body
  };

  // Identifies a point across searches.
  struct Named {
    int contact = -1;
    contact::TouchingSurfaces::Key key;
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

  const model::Model& model_;
  World& world_;
  std::vector<int> contacts_;        // contacts that strike
  std::vector<Point> points_;        // their points that may touch
  std::vector<double> restitution_;  // (rows,)
  std::vector<Named> rests_;         // points that must come to rest
  double closed_ = 0.0;              // m: smaller gaps are closed
  double still_ = 0.0;               // m/s: smaller velocities are zero
  double shortest_ = 0.0;            // s, minimum length of a part
  double deepest_ = 0.0;             // m, smallest gap at the start of the part
  double time_ = 0.0;                // s, start of the part
  bool found_rest_ = false;
};

}  // namespace sinew::world
