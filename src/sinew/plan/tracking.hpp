/// @file
/// Feedback that keeps an arm on its plan: a linear quadratic regulator of variable gain
/// (Kwakernaak & Sivan, Linear Optimal Control Systems, 1972, sec. 6.4) on the linearised implicit
/// step.
#pragma once

#include <memory>
#include <vector>

#include "sinew/plan/replay.hpp"

namespace sinew::plan {

/// x1 = A x0 + B torque to first order, x = (q, q').
struct StepLinearisation {
  MatrixX state;  ///< A (2n, 2n)
  MatrixX input;  ///< B (2n, inputs)
};

/// Of a step of backward Euler, q1 = q0 + h v1 with r(q1, v1, (v1 - v0)/h) = B tau:
///   D dv1 = H/h dv0 - r_q dq0 + B dtau,   D = h r_q + r_v + H/h,   dq1 = dq0 + h dv1.
/// @param equations of the arm. @param q,rate,acceleration (n,) each, at the step's end.
/// @param h time step, s.
StepLinearisation linearise_step(pcc::ArmEquations& equations, const VectorX& q,
                                 const VectorX& rate, const VectorX& acceleration, double h);

/// One step back of Riccati's recursion.
struct RiccatiStep {
  MatrixX gain;  ///< K (inputs, 2n): torque = nominal - K (x - nominal)
  MatrixX cost;  ///< P (2n, 2n) of what is left before the step
};
/// K = (R + B'PB)^-1 B'PA, P before = Q + A'P(A - BK), with P the cost after the step.
/// @param step A and B. @param state_cost Q (2n, 2n). @param input_cost R (inputs, inputs).
/// @param after P (2n, 2n).
RiccatiStep riccati_step(const StepLinearisation& step, const MatrixX& state_cost,
                         const MatrixX& input_cost, const MatrixX& after);

/// What errors are as bad as each other (Bryson's rule: costs are their inverse squares), all > 0.
struct TrackingSettings {
  double time_step = 5e-3;       ///< s, of control: the torque is held that long
  double angle = 0.5;            ///< rad, on the way
  double rate = 5.0;             ///< rad/s, on the way
  double torque_fraction = 0.5;  ///< of an input's range of torque, on the way
  double tip_position = 5e-3;    ///< m, at the end
  double tip_speed = 5e-2;       ///< m/s, at the end
};

/// The plan's nominal motion and its gains. Immutable.
class Tracker {
 public:
  /// @param arm planned for. @param task that was planned. @param plan to follow.
  /// @param settings of the regulator. Throws Error(out-of-range): a setting that is not positive.
  Tracker(std::shared_ptr<const pcc::Arm> arm, const PlanTask& task, const Plan& plan,
          const TrackingSettings& settings = {});

  int steps() const { return static_cast<int>(gains_.size()); }
  double time_step() const { return time_step_; }  ///< s
  const PlanTask& task() const { return task_; }   ///< completed
  const MatrixX& gain(int k) const { return gains_[static_cast<std::size_t>(k)]; }
  /// The nominal state (2n,) at the start of step k; k = steps(): at the end.
  VectorX state(int k) const { return states_.row(k); }
  /// (inputs,) N m in step k, within the limits. @param k which. @param q,rate (n,) measured.
  VectorX torque(int k, const VectorX& q, const VectorX& rate) const;
  VectorX nominal_torque(int k) const { return torques_.row(k); }

 private:
  PlanTask task_;
  double time_step_ = 0.0;
  MatrixX states_, torques_;
  std::vector<MatrixX> gains_;
};

/// What an arm that differs from the planned one, or starts elsewhere, makes of a plan.
struct TrackingTrial {
  VectorX position, rate;   ///< (coordinates,) start; empty: the task's
  bool feedback = true;     ///< else the nominal torque, open loop
  double time_step = 1e-3;  ///< s, about, of the simulation
};
Replay track(std::shared_ptr<const pcc::Arm> arm, const Tracker& tracker,
             const TrackingTrial& trial = {});

}  // namespace sinew::plan
