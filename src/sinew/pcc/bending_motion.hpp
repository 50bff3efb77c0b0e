/// @file
/// A bending actuator over time.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/mechanics/integrator.hpp"
#include "sinew/pcc/bending_actuator.hpp"

namespace sinew::pcc {

struct BendingMotionSettings {
  /// Backward Euler and the others are stable at every step; generalized-alpha is of second order
  /// and damps what a step cannot resolve, without a start of its own.
  mechanics::Integrator integrator = mechanics::Integrator::generalized_alpha;
  double spectral_radius = 0.8;  ///< of generalized-alpha, 0 to 1
};

struct BendingState {
  double time = 0.0;          ///< s
  double angle = 0.0;         ///< rad
  double rate = 0.0;          ///< rad/s
  double acceleration = 0.0;  ///< rad/s^2
  double pressure = 0.0;      ///< Pa
};

/// The data of one run. A step solves the equation of motion at its end, by Newton's method with
/// exact derivatives, for the motion d of `mechanics::StepWeights`; it allocates nothing.
class BendingMotion {
 public:
  /// @param actuator shared, not changed.
  /// @param start angle (rad), rate (rad/s), time (s) and pressure (Pa); its acceleration follows.
  /// @param settings how to integrate.
  /// Throws Error(out-of-range | not-finite) for a start outside the model's angles, a spectral
  /// radius outside 0 to 1, or a pressure that the modulus refuses.
  BendingMotion(std::shared_ptr<const BendingActuator> actuator, const BendingState& start,
                const BendingMotionSettings& settings = {});

  /// @param time_step s, > 0; may change from step to step (BDF2 is stable while it grows less
  /// than 2.4 times). @param pressure Pa at the step's end.
  /// Throws Error(not-converged) and leaves the state as it was when no angle of the model meets
  /// the equation; out-of-range for the step or a pressure that the modulus refuses.
  const BendingState& step(double time_step, double pressure);

  const BendingState& state() const { return state_; }
  const BendingActuator& actuator() const { return *actuator_; }

 private:
  void prepare(double time_step);

  std::shared_ptr<const BendingActuator> actuator_;
  BendingMotionSettings settings_;
  BendingState state_;
  mechanics::StepWeights weights_;
  double prepared_step_ = 0.0, prepared_before_ = -1.0;
  double step_before_ = 0.0;
  double first_ = 0.0, second_ = 0.0;  // what the integrator keeps
};

/// The states at given times: a pressure history may be sampled unevenly and have gaps.
/// @param actuator shared.
/// @param times (n,) s, increasing, n >= 2.
/// @param pressures (n,) Pa, straight lines between.
/// @param start of angle and rate at times[0]; its time and pressure are not read.
/// @param longest_step s, > 0: intervals are divided evenly into steps no longer.
/// @param settings how to integrate.
/// Returns n states. Throws Error(wrong-length | too-few-points | non-monotonic-time | not-finite),
/// and what a step does.
std::vector<BendingState> simulate(std::shared_ptr<const BendingActuator> actuator,
                                   std::span<const double> times, std::span<const double> pressures,
                                   const BendingState& start, double longest_step,
                                   const BendingMotionSettings& settings = {});

}  // namespace sinew::pcc
