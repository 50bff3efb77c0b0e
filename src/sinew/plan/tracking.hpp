/// @file
/// Feedback that keeps an arm on its plan: a time-varying linear quadratic regulator (Kwakernaak &
/// Sivan, Linear Optimal Control Systems, 1972, sec. 6.4) for the linearised implicit step.
#pragma once

#include <memory>
#include <vector>

#include "sinew/plan/replay.hpp"

namespace sinew::plan {

/// A linearised step x1 = A x0 + B torque, with the state x = (q, q').
struct StepLinearisation {
  MatrixX state;  ///< A (2n, 2n)
  MatrixX input;  ///< B (2n, inputs)
};

/// Linearises a step of backward Euler, q1 = q0 + h v1 with r(q1, v1, (v1 - v0)/h) = B tau:
///   D dv1 = H/h dv0 - r_q dq0 + B dtau,   D = h r_q + r_v + H/h,   dq1 = dq0 + h dv1.
/// @param equations of the arm. @param q,rate,acceleration (n,) each, at the end of the step.
/// @param h time step, s.
StepLinearisation linearise_step(pcc::ArmEquations& equations, const VectorX& q,
                                 const VectorX& rate, const VectorX& acceleration, double h);

/// The result of one backward step of the Riccati recursion.
struct RiccatiStep {
  MatrixX gain;  ///< K (inputs, 2n): torque = nominal - K (x - nominal)
  MatrixX cost;  ///< P (2n, 2n), cost-to-go before the step
};
/// Computes K = (R + B'PB)^-1 B'PA and the cost before the step, Q + A'P(A - BK), where P is the
/// cost-to-go after the step.
/// @param step A and B. @param state_cost Q (2n, 2n). @param input_cost R (inputs, inputs).
/// @param after P (2n, 2n).
RiccatiStep riccati_step(const StepLinearisation& step, const MatrixX& state_cost,
                         const MatrixX& input_cost, const MatrixX& after);

/// Errors of equal cost (Bryson's rule: costs are their inverse squares), all > 0.
struct TrackingSettings {
  double time_step = 5e-3;       ///< s, control period, over which the torque is held
  double angle = 0.5;            ///< rad, along the path
  double rate = 5.0;             ///< rad/s, along the path
  double torque_fraction = 0.5;  ///< of half an input's range of torque, along the path
  double tip_position = 5e-3;    ///< m, at the end
  double tip_speed = 5e-2;       ///< m/s, at the end
};

/// The nominal motion of a plan, with the gains of its regulator. Immutable.
class Tracker {
 public:
  /// Throws Error(out-of-range) for a setting that is not positive.
  /// @param arm of the plan. @param task that was planned. @param plan to follow.
  /// @param settings of the regulator.
  Tracker(std::shared_ptr<const pcc::Arm> arm, const PlanTask& task, const Plan& plan,
          const TrackingSettings& settings = {});

  int steps() const { return static_cast<int>(gains_.size()); }
  double time_step() const { return time_step_; }  ///< s
  const PlanTask& task() const { return task_; }   ///< completed
  const MatrixX& gain(int k) const { return gains_[static_cast<std::size_t>(k)]; }
  /// The nominal state (2n,) at the start of step k; for k = steps(), at the end.
  VectorX state(int k) const { return states_.row(k); }
  /// Torques (inputs,) in step k, N m, within the limits. @param k step. @param q,rate (n,)
  /// measured.
  VectorX torque(int k, const VectorX& q, const VectorX& rate) const;
  VectorX nominal_torque(int k) const { return torques_.row(k); }

 private:
  PlanTask task_;
  double time_step_ = 0.0;
  MatrixX states_, torques_;
  std::vector<MatrixX> gains_;
};

/// A trial of a tracker on an arm that may differ from the planned one or start elsewhere.
struct TrackingTrial {
  VectorX position, rate;   ///< (coordinates,) initial state; empty: that of the task
  bool feedback = true;     ///< if false, the nominal torque is applied open loop
  double time_step = 1e-3;  ///< s, approximate, of the simulation
};
/// Simulates a trial. @param arm to be simulated. @param tracker of the plan. @param trial see
/// there.
Replay track(std::shared_ptr<const pcc::Arm> arm, const Tracker& tracker,
             const TrackingTrial& trial = {});

}  // namespace sinew::plan
