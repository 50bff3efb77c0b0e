#include "sinew/plan/tracking.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/linalg/dense.hpp"
#include "sinew/linalg/dense_factor.hpp"
#include "sinew/pcc/arm_simulation.hpp"

namespace sinew::plan {

namespace {

void check(const TrackingSettings& settings) {
  const std::pair<const char*, double> all[] = {{"time_step", settings.time_step},
                                                {"angle", settings.angle},
                                                {"rate", settings.rate},
                                                {"torque_fraction", settings.torque_fraction},
                                                {"tip_position", settings.tip_position},
                                                {"tip_speed", settings.tip_speed}};
  for (const auto& [name, value] : all) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw Error(ErrorKind::out_of_range, {.item = name}, fmt::format("{:g}", value),
                  "give more than zero");
    }
  }
}

double squared(double value) { return value * value; }

}  // namespace

StepLinearisation linearise_step(pcc::ArmEquations& equations, const VectorX& q,
                                 const VectorX& rate, const VectorX& acceleration, double h) {
  const auto& linear = equations.linearise(q, rate, acceleration);
  const Eigen::Index n = q.size();
  const MatrixX inertia = linear.by_acceleration / h;
  const linalg::LuFactor step(h * linear.by_position + linear.by_rate + inertia);
  const MatrixX& actuation = equations.arm().actuation();
  MatrixX moved(n, 2 * n), rates(n, 2 * n), driven(n, actuation.cols());
  moved << -linear.by_position, inertia;
  step.solve_columns(moved, rates);
  step.solve_columns(actuation, driven);
  StepLinearisation result{MatrixX(2 * n, 2 * n), MatrixX(2 * n, driven.cols())};
  result.state << h * rates, rates;
  result.state.topLeftCorner(n, n) += MatrixX::Identity(n, n);
  result.input << h * driven, driven;
  return result;
}

RiccatiStep riccati_step(const StepLinearisation& step, const MatrixX& state_cost,
                         const MatrixX& input_cost, const MatrixX& after) {
  const MatrixX weighted = step.input.transpose() * after;
  RiccatiStep result;
  result.gain = linalg::solve_symmetric(input_cost + weighted * step.input, weighted * step.state);
  const MatrixX cost =
      state_cost + step.state.transpose() * after * (step.state - step.input * result.gain);
  result.cost = 0.5 * (cost + cost.transpose());
  return result;
}

Tracker::Tracker(std::shared_ptr<const pcc::Arm> arm, const PlanTask& task, const Plan& plan,
                 const TrackingSettings& settings)
    : task_(completed(*arm, task)) {
  check(settings);
  const Eigen::Index n = arm->coordinates(), inputs = arm->inputs();
  const auto count =
      whole_count<Eigen::Index>(std::max(1.0, std::round(plan.duration() / settings.time_step)),
                                1e9, "control periods of a plan", "increase the time step");
  time_step_ = plan.duration() / static_cast<double>(count);
  // The nominal motion is that under the torque held over each control period, in five steps per
  // period.
  constexpr Eigen::Index kFine = 5;
  pcc::ArmSimulation simulation(arm, {.time_step = time_step_ / kFine});
  simulation.set_state(task_.start.position, task_.start.rate);
  states_.resize(count + 1, 2 * n);
  torques_.resize(count, inputs);
  states_.row(0) << simulation.position().transpose(), simulation.rate().transpose();
  for (Eigen::Index k = 0; k < count; ++k) {
    torques_.row(k) = plan.torque((static_cast<double>(k) + 0.5) * time_step_);
    for (Eigen::Index i = 0; i < kFine; ++i) simulation.step(torques_.row(k).transpose());
    states_.row(k + 1) << simulation.position().transpose(), simulation.rate().transpose();
  }

  pcc::ArmEquations& equations = simulation.equations();
  VectorX state_cost(2 * n);
  state_cost.head(n).setConstant(time_step_ / squared(settings.angle));
  state_cost.tail(n).setConstant(time_step_ / squared(settings.rate));
  VectorX input_cost(inputs), driven(inputs);
  for (Eigen::Index u = 0; u < inputs; ++u) {
    const double lower = task_.limits.torque_lower[u], upper = task_.limits.torque_upper[u];
    const bool limited = lower > -kNoBound && upper < kNoBound;
    const double range = limited ? 0.5 * (upper - lower) : arm->stiffness().maxCoeff();
    // An input without range is not used.
    driven[u] = range > 0.0 ? 1.0 : 0.0;
    input_cost[u] = range > 0.0 ? time_step_ / squared(settings.torque_fraction * range) : 1.0;
  }
  const VectorX q = states_.row(count).head(n), rate = states_.row(count).tail(n);
  const auto tip = equations.point({arm->segments() - 1}, q, rate);
  // The errors of the tip are J dq in position and J dq' + J' dq in velocity.
  MatrixX by_state = MatrixX::Zero(6, 2 * n);
  by_state.topLeftCorner(3, n) = tip.jacobian / settings.tip_position;
  by_state.bottomLeftCorner(3, n) = tip.jacobian_rate / settings.tip_speed;
  by_state.bottomRightCorner(3, n) = tip.jacobian / settings.tip_speed;
  MatrixX cost = by_state.transpose() * by_state;
  cost.diagonal() += state_cost;
  gains_.resize(static_cast<std::size_t>(count));
  for (Eigen::Index k = count - 1; k >= 0; --k) {
    const VectorX next = states_.row(k + 1);
    const VectorX acceleration =
        (states_.row(k + 1) - states_.row(k)).tail(n).transpose() / time_step_;
    StepLinearisation step =
        linearise_step(equations, next.head(n), next.tail(n), acceleration, time_step_);
    step.input = step.input * driven.asDiagonal();
    RiccatiStep before = riccati_step(step, MatrixX(state_cost.asDiagonal()),
                                      MatrixX(input_cost.asDiagonal()), cost);
    gains_[static_cast<std::size_t>(k)] = std::move(before.gain);
    cost = std::move(before.cost);
  }
}

VectorX Tracker::torque(int k, const VectorX& q, const VectorX& rate) const {
  VectorX error(states_.cols());
  error << q, rate;
  error -= states_.row(k).transpose();
  const VectorX torque = torques_.row(k).transpose() - gain(k) * error;
  return torque.cwiseMax(task_.limits.torque_lower).cwiseMin(task_.limits.torque_upper);
}

Replay track(std::shared_ptr<const pcc::Arm> arm, const Tracker& tracker,
             const TrackingTrial& trial) {
  const PlanTask& task = tracker.task();
  const VectorX q = trial.position.size() > 0 ? trial.position : task.start.position;
  const VectorX rate = trial.rate.size() > 0 ? trial.rate : task.start.rate;
  const auto fine =
      whole_count<Eigen::Index>(std::max(1.0, std::round(tracker.time_step() / trial.time_step)),
                                1e9, "time steps of a control period", "increase the time step");
  const double h = tracker.time_step() / static_cast<double>(fine);
  pcc::ArmSimulation simulation(arm, {.time_step = h});
  simulation.set_state(q, rate);
  const Eigen::Index steps = fine * tracker.steps();
  Recorder recorder(arm, task, VectorX::LinSpaced(steps + 1, 0.0, static_cast<double>(steps) * h));
  VectorX torque = tracker.nominal_torque(0);
  recorder.add(simulation.position(), simulation.rate(), torque);
  for (int k = 0; k < tracker.steps(); ++k) {
    torque = trial.feedback ? tracker.torque(k, simulation.position(), simulation.rate())
                            : tracker.nominal_torque(k);
    for (Eigen::Index i = 0; i < fine; ++i) {
      simulation.step(torque);
      recorder.add(simulation.position(), simulation.rate(), torque);
    }
  }
  return recorder.finish();
}

}  // namespace sinew::plan
