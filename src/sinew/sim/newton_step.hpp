/// @file
/// Solution of a step by Newton's method, with fallbacks.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "sinew/core/error.hpp"
#include "sinew/sim/joint_conflict.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/state.hpp"

namespace sinew::step {
struct ActuatorBlock;
}

namespace sinew::sim {

struct Run;

/// Solves a step by Newton's method. In quasi-statics, where no inertia indicates the direction of
/// motion, a failure is followed by load stepping of loads and commands, and finally by descent
/// with the projected tangent.
class NewtonStep {
 public:
  /// @param run must outlive it; its step has begun when solve() is called.
  /// @param divisible whether the caller can retry with smaller steps.
  NewtonStep(Run& run, bool divisible) : run_(run), divisible_(divisible) {}
  /// Moves the bodies and fills the report. Throws Error(not-converged), after which the run is as
  /// before the step. @param time_step s.
  void solve(double time_step);

 private:
  bool follows() const;
  bool holds_motion() const;
  NewtonSettings settings(double time_step) const;
  NewtonSettings settings_of_part(double time_step) const;
  std::string describe(const NewtonReport& result, const NewtonSettings& how) const;
  std::string remedy(NewtonStatus status) const;
  NewtonReport search(double time_step);
  bool searches_on(const NewtonReport& result) const;
  std::optional<NewtonReport> hold_motors(double time_step);
  NewtonReport hold_choice(const NewtonReport& chosen, double time_step);
  NewtonReport stay(double time_step);
  NewtonReport return_to_start(double time_step);
  bool stays_where_it_was(double time_step);
  NewtonReport remain(double time_step, const NewtonReport& failed);
  NewtonReport approach(double time_step);
  NewtonReport descend(double time_step, int iterations);
  bool must_settle() const;
  bool is_near(NewtonReport& result);
  double correction();
  double correction(const NewtonReport& result);
  void bound_distance(const NewtonReport& result);
  bool is_usable(const NewtonReport& result) const;
  bool solves(const NewtonReport& result);
  bool snaps(const NewtonReport& result) const;
  static ErrorKind kind_of(const NewtonReport& result);
  void fail_at_limit_point(const NewtonReport& result, double time_step);
  std::string describe_end() const;
  bool is_unstable(double time_step);
  bool falls(const NewtonReport& failed, double time_step);
  std::string describe_efforts(std::span<const step::ActuatorBlock> goal) const;
  std::string describe_choice() const;
  JointConflict find_conflict(const NewtonReport& result, double time_step) const;
  void take_report(const NewtonReport& result);

  Run& run_;
  bool divisible_;
  bool approached_ = false;    // whether approach() has run, which sets the next two
  State sound_;                // the last equilibrium on the way
  double reached_ = 0.0;       // fraction of the step's changes there
  bool part_snapped_ = false;  // whether a part of approach() left its branch
  bool descended_ = false;     // whether the result is that of descend()
  int tried_fallbacks_ = 0;    // iterations in which the exact tangent was indefinite
};

}  // namespace sinew::sim
