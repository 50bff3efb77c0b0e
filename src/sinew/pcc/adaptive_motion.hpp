/// @file
/// An arm by itself in time to an accuracy that is asked for: what other integrators and
/// transcriptions are measured by.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>

#include <Eigen/LU>

#include "sinew/pcc/arm_equations.hpp"

namespace sinew::pcc {

/// What a step may leave of error in each coordinate: absolute + relative * size.
struct Accuracy {
  double relative = 1e-6;  ///< >= 0
  double angle = 1e-8;     ///< rad (extension: m), > 0
  double rate = 1e-6;      ///< rad/s, > 0
  long max_steps = 100000;
};

/// Integrates r(q, q', q'') = B tau by the singly diagonally implicit Runge-Kutta method of five
/// stages, order four, stiffly accurate and L-stable, with an embedded formula of order three that
/// chooses the steps (Hairer & Wanner, Solving Ordinary Differential Equations II, 1996, IV.6,
/// table 6.5). Unknowns are the stages' accelerations, so that the mass matrix, nearly singular for
/// lumped masses, is never inverted.
class AdaptiveMotion {
 public:
  /// (inputs,) N m at a time in s.
  using Torque = std::function<VectorX(double)>;

  /// At rest and straight. @param arm that moves. @param accuracy of every step.
  explicit AdaptiveMotion(std::shared_ptr<const Arm> arm, const Accuracy& accuracy = {});

  double time() const { return time_; }                          ///< s
  const VectorX& position() const { return q_; }                 ///< (coordinates,) rad; e: m
  const VectorX& rate() const { return rate_; }                  ///< (coordinates,) rad/s
  const VectorX& acceleration() const { return acceleration_; }  ///< after a step, rad/s^2
  long steps() const { return steps_; }                          ///< taken since construction
  /// A new start. @param q,rate (coordinates,). @param time s.
  void set_state(const VectorX& q, const VectorX& rate, double time = 0.0);

  /// Goes on to a time. @param end s, after time(). @param torque smooth after time() and up to
  /// `end`: where it jumps or has a kink a new advance() begins. At a jump it is the value before.
  /// Throws Error(not-converged): no step is short enough, or there are too many.
  void advance(double end, const Torque& torque);

 private:
  static constexpr std::size_t kStages = 5;

  /// The estimated error of a step of h, 1: as large as allowed. Nothing where Newton's method
  /// fails.
  std::optional<double> attempt(double h, const Torque& torque);
  /// Solves for the stage's acceleration. False where Newton's method fails.
  bool solve_stage(std::size_t stage, double h, const VectorX& drive);
  double error(double h);
  /// Largest of changes of position and rate over what is allowed.
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
