/// @file
/// Integrates the motion of a single arm to a given accuracy. It is the reference for other
/// integrators and for transcriptions.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include <Eigen/LU>

#include "sinew/pcc/arm_equations.hpp"

namespace sinew::pcc {

/// The error that a step may have in each coordinate: absolute + relative * size.
struct Accuracy {
  double relative = 1e-6;  ///< >= 0
  double angle = 1e-8;     ///< rad (extension: m), > 0
  double rate = 1e-6;      ///< rad/s, > 0
  long max_steps = 100000;
};

/// Integrates r(q, q', q'') = B tau by a singly diagonally implicit Runge-Kutta method of five
/// stages and order four, which is stiffly accurate and L-stable. An embedded formula of order
/// three controls the step size (Hairer & Wanner, Solving Ordinary Differential Equations II, 1996,
/// IV.6, table 6.5). The unknowns are the accelerations of the stages, so that the mass matrix,
/// which is nearly singular for lumped masses, is never inverted.
class AdaptiveMotion {
 public:
  /// Torques (inputs,) N m as a function of time, s.
  using Torque = std::function<VectorX(double)>;

  /// Starts at rest, with the arm straight. @param arm that moves. @param accuracy of every step.
  explicit AdaptiveMotion(std::shared_ptr<const Arm> arm, const Accuracy& accuracy = {});

  double time() const { return time_; }                          ///< s
  const VectorX& position() const { return q_; }                 ///< (coordinates,) rad; e: m
  const VectorX& rate() const { return rate_; }                  ///< (coordinates,) rad/s
  const VectorX& acceleration() const { return acceleration_; }  ///< after a step, rad/s^2
  long steps() const { return steps_; }                          ///< taken since construction
  /// Sets the state. @param q,rate (coordinates,). @param time s.
  void set_state(const VectorX& q, const VectorX& rate, double time = 0.0);

  /// Integrates up to a time. Throws Error(not-converged) if no step is short enough, or if there
  /// are too many steps.
  /// @param end s, after time(). @param torque smooth after time() and up to `end`. Call advance()
  /// anew at each jump or kink; at a jump, `torque` returns the value before it.
  void advance(double end, const Torque& torque);

 private:
  static constexpr std::size_t kStages = 5;

  /// Tries a step of length h. Returns its estimated error relative to the allowed one, or nothing
  /// if Newton's method fails.
  std::optional<double> attempt(double h, const Torque& torque);
  /// Solves for the acceleration of a stage. Returns false if Newton's method fails.
  bool solve_stage(std::size_t stage, double h, const VectorX& drive);
  double error(double h);
  /// Largest change of a position or rate relative to its allowed error.
  double size(const VectorX& position, const VectorX& rate) const;

  ArmEquations equations_;
  Accuracy accuracy_;
  double time_ = 0.0, next_ = 1e-4;
  long steps_ = 0;
  VectorX q_, rate_, acceleration_;
  VectorX allowed_angle_, allowed_rate_;
  std::array<VectorX, kStages> stage_rate_, stage_acceleration_;
  VectorX stage_q_, change_, estimate_q_, estimate_rate_;
  MatrixX inertia_, damping_, stiffness_;
  Eigen::PartialPivLU<MatrixX> matrix_;
};

}  // namespace sinew::pcc
