/// @file
/// A time step from one impact to the next.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/sim/impact.hpp"
#include "sinew/sim/midpoint.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/striking_points.hpp"
#include "sinew/sim/substep.hpp"

namespace sinew::sim {

struct Run;

/// Event-driven integration (Acary & Brogliato, Numerical Methods for Nonsmooth Dynamical Systems,
/// 2008, ch. 8). Where rigid bodies touch, points are open or closed. A part of the step is made as
/// if open points could pass through; where a gap would close in it, it is made again, up to there.
/// Then an impact is solved (Impact), and the next part begins.
///
/// A part is a step of the midpoint rule (Midpoint). It is one of backward Euler where half a
/// motion says little about the other half: where deformable bodies touch anything or their bases
/// move, where actuators are told motions, joints or cables rub, drives or materials have memories.
/// It ends in its middle where something else catches a body (a joint's limit, a cable that becomes
/// taut, a point that stops to slide), and at the corners of motions that are given.
///
/// A rebound that would rise less than 1e-9 of the robot's size is none: the impact is solved again
/// without restitution, and the point stays closed. That ends the infinite sequences of rebounds
/// (Zeno). Which points are closed follows from gaps and velocities alone.
class EventStepper {
 public:
  /// @param run outlives it.
  explicit EventStepper(Run& run);
  /// Advances the run by a time step. @param begin,time_step s. Throws Error; the run is then
  /// somewhere in the step.
  void step(double begin, double time_step);
  /// Whether a base has moved in it.
  bool moved_bases() const { return moved_bases_; }
  std::size_t bytes() const { return sizeof(double) * (start_.size() + struck_.size()); }

 private:
  void make_parts(double begin, double time_step);
  void collide(double time);
  double advance(double time, double left);
  double move(double time, double length);
  bool is_smooth(double end, double length);
  bool stays_smooth() const;
  bool turns_too_far();
  void rest(double time);
  void hold(double time);
  [[noreturn]] void give_up(const char* what);

  Run& run_;
  Substep substep_;
  Midpoint midpoint_;
  Impact impact_;
  StrikingPoints points_;
  State start_, struck_;               // of a part; before the impact that it begins with
  int strikes_ = 0;                    // impacts since struck_
  double longest_ = 0.0;               // s, part of the step in hand: others fail
  bool carried_on_ = false;            // the last part, by the midpoint rule
  bool moved_bases_ = false;           // in some part
  std::vector<double> effort_before_;  // (rows,) N
};

}  // namespace sinew::sim
