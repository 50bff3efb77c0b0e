/// @file
/// Event-driven time steps, divided at impacts.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/run/state.hpp"
#include "sinew/step/impact.hpp"
#include "sinew/step/midpoint.hpp"
#include "sinew/step/substep.hpp"
#include "sinew/world/striking_points.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::step {

/// Event-driven integration (Acary & Brogliato, Numerical Methods for Nonsmooth Dynamical Systems,
/// 2008, ch. 8). Contact points of rigid bodies are open or closed. A part of the step is made as
/// if open points could pass through surfaces; if a gap closes in it, the part is repeated up to
/// the time of closure. Then the impact is solved (Impact), and the next part begins.
///
/// A part is a step of the midpoint rule (Midpoint), or of backward Euler if half a motion does not
/// predict the other half: if deformable bodies have contact or moving bases, if motions of
/// deformable bodies are commanded or commanded motions have no velocity (a script gives a new
/// value in every step), if joints or cables have friction, or if drives or materials have memory.
/// It ends in its middle if something else stops a body (a joint limit, a cable that
/// becomes taut, a point that stops sliding), and at the corners of prescribed and commanded
/// motions.
///
/// A rebound by less than 1e-9 of the robot's size is suppressed: the impact is solved again
/// without restitution, and the point stays closed. This ends infinite sequences of rebounds (Zeno
/// behaviour). Gaps and velocities alone determine which points are closed.
class EventStepper {
 public:
  /// @param run must outlive it.
  explicit EventStepper(run::Run& run);
  /// Advances the run by a time step.
  /// @param begin,time_step s. Throws Error, after which the run is at some time within the step.
  void step(double begin, double time_step);
  std::size_t bytes() const { return sizeof(double) * (start_.size() + struck_.size()); }

 private:
  void make_parts(double begin, double time_step);
  void collide(double time);
  double advance(double time, double left);
  double move(double time, double length);
  double next_corner(double time) const;
  bool is_smooth(double begin, double length);
  bool stays_smooth() const;
  void solve_again(double begin, double length);
  bool turns_too_far(double length);
  void rest(double time);
  void hold(double time, double length);
  void find_end_efforts(double length);
  [[noreturn]] void give_up(const char* what);

  run::Run& run_;
  Substep substep_;
  Midpoint midpoint_;
  Impact impact_;
  world::StrikingPoints points_;
  run::State start_, struck_;          // at the start of a part; before the impact at its start
  int strikes_ = 0;                    // impacts since struck_
  double longest_ = 0.0;               // s, longest part of this step that has not failed
  bool carried_on_ = false;            // whether the last part followed the midpoint rule
  std::vector<double> effort_before_;  // (rows,) N
};

}  // namespace sinew::step
