/// @file
/// A step's equation solved by Newton's method, and by longer ways where that finds nothing.
#pragma once

#include <optional>

#include "sinew/sim/joint_conflict.hpp"
#include "sinew/sim/newton.hpp"

namespace sinew::sim {

struct Run;

/// Newton; where that finds nothing and there is no inertia to say where to go, along the loads and
/// commands in parts, and last downhill.
class NewtonStep {
 public:
  /// @param run outlives it; its step has begun when solve() is called.
  /// @param divisible smaller steps are tried where this one finds no end.
  NewtonStep(Run& run, bool divisible) : run_(run), divisible_(divisible) {}
  /// Moves the bodies and reports. Throws Error(not-converged), the run then being as before the
  /// step. @param time_step s.
  void solve(double time_step);

 private:
  NewtonSettings settings(double time_step) const;
  NewtonSettings settings_of_part(double time_step) const;
  NewtonReport search(double time_step);
  std::optional<NewtonReport> hold_motors(double time_step);
  NewtonReport hold_choice(const NewtonReport& chosen, double time_step);
  NewtonReport stay(double time_step);
  NewtonReport remain(double time_step, const NewtonReport& failed);
  NewtonReport approach(double time_step);
  NewtonReport descend(double time_step, int iterations);
  bool is_usable(const NewtonReport& result) const;
  JointConflict find_conflict(const NewtonReport& result, double time_step) const;
  void take_report(const NewtonReport& result);

  Run& run_;
  bool divisible_;
};

}  // namespace sinew::sim
