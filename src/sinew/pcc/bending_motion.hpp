/// @file
/// Simulates a bending actuator in time.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/mechanics/integrator.hpp"
#include "sinew/pcc/bending_actuator.hpp"

namespace sinew::pcc {

struct BendingMotionSettings {
  /// All integrators are stable for every step size. Generalized-alpha is of second order, damps
  /// motion that a step cannot resolve, and needs no special first step here.
  mechanics::Integrator integrator = mechanics::Integrator::generalized_alpha;
  double spectral_radius = 0.8;  ///< of generalized-alpha, 0 to 1
};

/// The state of an actuator at one time.
struct BendingState {
  double time = 0.0;          ///< s
  double angle = 0.0;         ///< rad
  double rate = 0.0;          ///< rad/s
  double acceleration = 0.0;  ///< rad/s^2
  double pressure = 0.0;      ///< Pa
};

/// A simulation of one actuator. A step solves the equation of motion at its end for the motion d
/// of `mechanics::StepWeights`, by Newton's method with exact derivatives. It does not allocate.
class BendingMotion {
 public:
  /// @param actuator shared and not changed.
  /// @param start angle, rate, time and pressure; the acceleration is computed from these.
  /// @param settings of the integrator.
  /// Throws Error(out-of-range | not-finite) for an initial angle outside the range of the model, a
  /// spectral radius outside 0 to 1, or a pressure that the modulus refuses.
  BendingMotion(std::shared_ptr<const BendingActuator> actuator, const BendingState& start,
                const BendingMotionSettings& settings = {});

  /// Advances one time step. If no angle of the model satisfies the equation of motion, throws
  /// Error(not-converged) and keeps the state. Throws Error(out-of-range) for the step size or a
  /// pressure that the modulus refuses.
  /// @param time_step s, > 0; may change from step to step (BDF2 is stable if it grows by less than
  /// a factor of 2.4). @param pressure Pa, at the end of the step.
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
  double first_ = 0.0, second_ = 0.0;  // history of the integrator
};

/// Simulates the response to a pressure history, which may be sampled unevenly and have gaps.
/// Returns the states at the given times. Throws Error(wrong-length | too-few-points |
/// non-monotonic-time | not-finite | out-of-range), and what BendingMotion::step() throws.
/// @param actuator shared and not changed.
/// @param times (n,) s, increasing, n >= 2.
/// @param pressures (n,) Pa, linearly interpolated.
/// @param start angle and rate at times[0]; its time and pressure are ignored.
/// @param longest_step s, > 0: each interval is divided evenly into steps of at most this length.
/// @param settings of the integrator.
std::vector<BendingState> simulate(std::shared_ptr<const BendingActuator> actuator,
                                   std::span<const double> times, std::span<const double> pressures,
                                   const BendingState& start, double longest_step,
                                   const BendingMotionSettings& settings = {});

}  // namespace sinew::pcc
