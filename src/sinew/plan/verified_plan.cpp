// Verification of plans. The motion under a plan's torques is simulated, and the program is solved
// again with a corrected aim or on a finer mesh, until the motion meets the task.
#include <algorithm>
#include <chrono>
#include <utility>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/plan/mesh.hpp"
#include "sinew/plan/planner.hpp"
#include "sinew/plan/replay.hpp"

namespace sinew::plan {

namespace {

/// The times of the knots, with `between` evenly spaced times between each two.
VectorX sample_times(const VectorX& knots, Eigen::Index between) {
  const Eigen::Index per = between + 1, intervals = knots.size() - 1;
  VectorX times(per * intervals + 1);
  for (Eigen::Index k = 0; k < intervals; ++k) {
    for (Eigen::Index i = 0; i < per; ++i) {
      const double fraction = static_cast<double>(i) / static_cast<double>(per);
      times[per * k + i] = knots[k] + fraction * (knots[k + 1] - knots[k]);
    }
  }
  times[per * intervals] = knots[intervals];
  return times;
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

struct Planner::Verdict {
  /// Final tip position and velocity of the motion minus those of the program, m and m/s.
  Vector3 position = Vector3::Zero(), velocity = Vector3::Zero();
  VectorX shortfall;        ///< (obstacles,) m, of clearance; <= 0: none
  double miss = kInfinity;  ///< largest of what is missed over what is allowed; <= 1: met; +inf:
                            ///< there is no motion
  bool coarse = true;       ///< the motions differ by more than the tolerances
};

Planner::Verdict Planner::verify(Plan& plan) {
  const auto begin = std::chrono::steady_clock::now();
  const Goal& goal = task_.goal;
  const Eigen::Index last = plan.knots.times.size() - 1;
  const VectorX q = plan.knots.position.row(last), rate = plan.knots.rate.row(last);
  const auto tip = equations_.point({arm_->segments() - 1}, q, rate);
  const Vector3 velocity = tip.jacobian * rate;
  plan.planned_tip_error = (tip.position - goal.position).norm();
  plan.planned_tip_speed = velocity.norm();
  plan.tip_error = plan.tip_speed = kInfinity;
  plan.clearance = -kInfinity;
  Verdict verdict;
  try {
    const Replay run =
        replay(arm_, task_, plan, sample_times(plan.knots.times, task_.obstacles.empty() ? 0 : 4));
    plan.tip_error = run.tip_error;
    plan.tip_speed = run.tip_speed;
    plan.clearance = run.clearance();
    const Eigen::Index end = run.times.size() - 1;
    verdict.position = run.tip.row(end).transpose() - tip.position;
    verdict.velocity = run.tip_velocity.row(end).transpose() - velocity;
    verdict.miss = std::max(plan.tip_error / goal.tolerance, plan.tip_speed / goal.speed_tolerance);
    verdict.coarse =
        verdict.position.norm() > goal.tolerance || verdict.velocity.norm() > goal.speed_tolerance;
    verdict.shortfall = -run.clearances;
    for (Eigen::Index o = 0; o < verdict.shortfall.size(); ++o) {
      verdict.shortfall[o] += task_.obstacles[static_cast<std::size_t>(o)].clearance;
      verdict.miss = std::max(verdict.miss, 1.0 + verdict.shortfall[o] / goal.tolerance);
    }
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_converged) throw;
    // The motion diverged, which happens for torques of a program that was not solved.
  }
  plan.seconds += seconds_since(begin);
  return verdict;
}

Plan Planner::corrected(const Plan& plan, const Verdict& verdict) {
  Aim aim = program_->aim();
  aim.position = verdict.position;
  aim.velocity = verdict.velocity;
  // Adds a margin, since the closest points move.
  aim.clearance += 1.1 * verdict.shortfall.cwiseMax(0.0);
  program_->set_aim(aim);
  return solve_program(plan.point);
}

Plan Planner::refined_plan(const Plan& plan) {
  const auto begin = std::chrono::steady_clock::now();
  const VectorX fractions = refined(plan.fractions(), interval_defects(arm_, task_, plan));
  const Aim aim{.clearance = program_->aim().clearance};
  set_mesh(fractions);
  program_->set_aim(aim);
  Knots guess = plan.knots;
  guess.times = VectorX::Zero(fractions.size() + 1);
  for (Eigen::Index k = 0; k < fractions.size(); ++k) {
    guess.times[k + 1] = guess.times[k] + fractions[k] * plan.duration();
  }
  const Replay run = replay(arm_, task_, plan, guess.times);
  guess.position = run.position;
  guess.rate = run.rate;
  guess.acceleration = slopes(run.times, run.rate);
  guess.torque = run.torque;
  const double spent = seconds_since(begin);
  Plan next = solve_program({program_->pack(guess), {}, {}, {}});
  next.seconds += spent;
  return next;
}

Plan Planner::solve_verified(const ProgramPoint& start) {
  Plan best = solve_program(start);
  best.iterations += std::exchange(before_iterations_, 0);
  best.seconds += std::exchange(before_seconds_, 0.0);
  Verdict verdict = verify(best);
  double least = verdict.miss;
  Plan plan = best;
  int aimed = 0;  // consecutive corrections of the aim on one mesh
  const auto spent = [&](const Plan& by) {
    best.iterations = by.iterations;
    best.seconds = by.seconds;
    best.corrections = by.corrections;
  };
  while (plan.found() && verdict.miss > 1.0 && verdict.miss < kInfinity &&
         plan.corrections < settings_.corrections && time_left() > 0.0) {
    constexpr int kMaxAimedRefinements = 3;
    const bool refine = verdict.coarse || aimed == kMaxAimedRefinements;
    aimed = refine ? 0 : aimed + 1;
    Plan next = refine ? refined_plan(plan) : corrected(plan, verdict);
    next.iterations += plan.iterations;
    next.seconds += plan.seconds;
    next.corrections = plan.corrections + 1;
    plan = std::move(next);
    verdict = verify(plan);
    if (plan.found() && verdict.miss < least) {
      least = verdict.miss;
      best = plan;
    }
    spent(plan);
  }
  if (best.found() && least > 1.0) best.status = PlanStatus::not_met_on_replay;
  return best;
}

}  // namespace sinew::plan
