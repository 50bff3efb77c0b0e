/// @file
/// One solution of a step's equation, over the whole time step or a part of it.
#pragma once

namespace sinew::sim {

struct Run;

/// What makers of steps share: begin, solve, end.
class Substep {
 public:
  /// @param run outlives it.
  explicit Substep(Run& run) : run_(run) {}

  /// Reads the commands of a part that ends at a time. @param end,time_step s.
  void read_commands(double end, double time_step);
  /// Keeps the state in Run::before, and begins. After read_commands().
  void begin(double time_step);
  /// Throws Error, and what a watcher throws; the run is then as it was before begin().
  /// @param time_step s, as for begin().
  /// @param divisible smaller parts are tried where this one finds no end.
  void solve(double time_step, bool divisible = false);
  /// Velocities follow, and what the part came to is counted. @return error estimate, m.
  double end(double time_step);
  /// The same where what was solved was the first half of a step of the midpoint rule, whose motion
  /// was then doubled. @param time_step s, of the whole.
  void end_as_midpoint(double time_step);

 private:
  void begin_world(double time_step);
  void solve_equation(double time_step, bool divisible);
  void solve_afresh(double time_step, bool divisible);
  bool reaches_back() const;
  bool stops_points(double time_step) const;
  double end_once(double time_step);
  bool jumps() const;
  bool has_gained() const;
  void count();

  Run& run_;
  bool stops_points_ = false;   // of contacts, which moved when the part began
  bool divisible_ = false;      // see solve()
  bool lands_by_bdf2_ = false;  // a point that lands in the part, which reaches back by BDF2
  double energy_before_ = 0.0;  // J, then: of the bodies when the part began
  bool held_before_ = false;    // a controller's choice, in earlier parts of the step
};

}  // namespace sinew::sim
