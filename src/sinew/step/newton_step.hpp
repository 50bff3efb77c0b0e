/// @file
/// Solution of a step by Newton's method, with fallbacks.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "sinew/core/error.hpp"
#include "sinew/run/newton.hpp"
#include "sinew/run/state.hpp"
#include "sinew/world/joint_conflict.hpp"

namespace sinew::law {
struct ActuatorBlock;
}

namespace sinew::run {
struct Run;
}

namespace sinew::step {

/// Solves a step by Newton's method. In quasi-statics, where no inertia indicates the direction of
/// motion, a failure is followed by load stepping of loads and commands, and finally by descent
/// with the projected tangent.
class NewtonStep {
 public:
  /// @param run must outlive it; its step has begun when solve() is called.
  /// @param divisible whether the caller can retry with smaller steps.
  NewtonStep(run::Run& run, bool divisible) : run_(run), divisible_(divisible) {}
  /// Moves the bodies and fills the report. Throws Error(not-converged), after which the run is as
  /// before the step. @param time_step s.
  void solve(double time_step);

 private:
  bool follows() const;
  bool holds_motion() const;
  run::NewtonSettings settings(double time_step) const;
  run::NewtonSettings settings_of_part(double time_step) const;
  std::string describe(const run::NewtonReport& result, const run::NewtonSettings& how) const;
  std::string remedy(run::NewtonStatus status) const;
  run::NewtonReport search(double time_step);
  bool searches_on(const run::NewtonReport& result) const;
  std::optional<run::NewtonReport> hold_motors(double time_step);
  run::NewtonReport hold_choice(const run::NewtonReport& chosen, double time_step);
  run::NewtonReport stay(double time_step);
  run::NewtonReport return_to_start(double time_step);
  bool stays_where_it_was(double time_step);
  run::NewtonReport remain(double time_step, const run::NewtonReport& failed);
  run::NewtonReport approach(double time_step);
  run::NewtonReport descend(double time_step, int iterations);
  bool must_settle() const;
  bool is_near(run::NewtonReport& result);
  double correction();
  double correction(const run::NewtonReport& result);
  void bound_distance(const run::NewtonReport& result);
  bool is_usable(const run::NewtonReport& result) const;
  bool solves(const run::NewtonReport& result);
  bool snaps(const run::NewtonReport& result) const;
  static ErrorKind kind_of(const run::NewtonReport& result);
  void fail_at_limit_point(const run::NewtonReport& result, double time_step);
  std::string describe_end() const;
  bool is_unstable(double time_step);
  bool falls(const run::NewtonReport& failed, double time_step);
  std::string describe_efforts(std::span<const law::ActuatorBlock> goal) const;
  std::string describe_choice() const;
  world::JointConflict find_conflict(const run::NewtonReport& result, double time_step) const;
  void take_report(const run::NewtonReport& result);

  run::Run& run_;
  bool divisible_;
  bool approached_ = false;    // whether approach() has run, which sets the next two
  run::State sound_;           // the last equilibrium on the way
  double reached_ = 0.0;       // fraction of the step's changes there
  bool part_snapped_ = false;  // whether a part of approach() left its branch
  bool descended_ = false;     // whether the result is that of descend()
  int tried_fallbacks_ = 0;    // iterations in which the exact tangent was indefinite
};

}  // namespace sinew::step
