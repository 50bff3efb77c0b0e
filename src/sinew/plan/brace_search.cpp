#include "sinew/plan/brace_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace sinew::plan {

namespace {

constexpr double kGapTolerance = 1e-6;  // m, for the violation left by the solver
constexpr double kViolation = 1e-9;
constexpr SolverSettings kSolver{.tolerance = 1e-9, .max_iterations = 120, .max_time = 5.0};
constexpr int kRounds = 5;
constexpr double kReserveTolerance = 1e-3;  // relative

/// Whether constraints are met. The cost need not be minimal.
bool is_equilibrium(const ProgramResult& result) {
  return result.status == Status::solved || result.status == Status::acceptable ||
         (result.status == Status::iteration_limit && result.violation < kViolation);
}

}  // namespace

BraceSearch::BraceSearch(std::shared_ptr<const pcc::Arm> arm, const BraceTask& task,
                         Reserve reserve)
    : arm_(std::move(arm)),
      task_(task),
      reserve_(reserve),
      equations_(arm_),
      points_(arm_),
      draw_(task.seed) {}

void BraceSearch::attempt(BraceProblem problem, int object, const VectorX& start) {
  ++tried_;
  problem.reserve = 0.0;
  VectorX x;
  Judged judged;
  for (int round = 0; round < kRounds; ++round) {
    BraceProgram program(arm_, problem);
    if (round == 0) {
      x.setZero(program.variables());
      x.head(start.size()) = start;
      x[program.hold_index()] = 0.5;
      // Initial guess of the force: twice the minimum, along the outward normal.
      const Points ends = equations_.endpoints(start.head(arm_->coordinates()));
      const Vector3 near = ends.row(problem.point.segment);
      const auto& surface = task_.objects[static_cast<std::size_t>(object)].surface;
      x.tail<3>() = 2.0 * problem.min_force * constraint::distance(surface, near).normal;
    }
    const ProgramResult found = solve(program, {x, {}, {}, {}}, kSolver);
    if (!is_equilibrium(found)) {
      if (round == 0) return;
      break;  // the friction condition of the last equilibrium shows what it lacks
    }
    x = found.point.x;
    judged = judge(program, object, x);
    if (round == 0) ++solved_;
    if (judged.brace.object < 0) {
      ++unstable_;
      return;
    }
    if (std::abs(judged.reserve - problem.reserve) <= kReserveTolerance * judged.reserve) break;
    problem.reserve = judged.reserve;
  }
  keep(judged);
}

VectorX BraceSearch::random_start(const BraceProblem& problem) {
  const ArmLimits& limits = problem.limits;
  VectorX start(arm_->coordinates() + 1 + arm_->inputs());
  Eigen::Index at = 0;
  for (Eigen::Index i = 0; i < arm_->coordinates(); ++i) {
    start[at++] = draw_(std::max(limits.angle_lower[i], -std::numbers::pi / 2.0),
                        std::min(limits.angle_upper[i], std::numbers::pi / 2.0));
  }
  start[at++] = draw_(problem.turn_lower, problem.turn_upper);
  for (Eigen::Index u = 0; u < arm_->inputs(); ++u) {
    start[at++] = draw_(limits.torque_lower[u], limits.torque_upper[u]);
  }
  return start;
}

Brace BraceSearch::finish(BraceStatus without) const {
  Brace result = best_.found() ? best_ : nearest_.brace;
  if (!best_.found()) result.status = without;
  result.tried = tried_;
  result.solved = solved_;
  result.unstable = unstable_;
  return result;
}

/// Evaluates an equilibrium. In the result, object is -1 if it is not stable.
BraceSearch::Judged BraceSearch::judge(BraceProgram& program, int object, const VectorX& x) {
  const BraceProblem& problem = program.problem();
  const int n = arm_->coordinates();
  VectorX values;
  program.constraints(x, values);
  Judged result;
  Brace& brace = result.brace;
  brace.segments = problem.point.segment + 1;
  brace.point = problem.point;
  brace.position = x.head(n);
  brace.turn = x[program.turn_index()];
  brace.torque = x.segment(program.torque_index(), arm_->inputs());
  brace.balance = values.head(n).cwiseAbs().maxCoeff();
  const Vector3 base = arm_->settings().base;
  const Matrix3 turn =
      Eigen::AngleAxisd(brace.turn, arm_->settings().frame.col(2)).toRotationMatrix();
  const auto at =
      points_.positions(brace.position, {{.segment = arm_->segments() - 1}, problem.point});
  brace.tip = base + turn * (at[0].value - base);
  brace.place = base + turn * (at[1].value - base);
  brace.tip_error = (brace.tip - task_.goal).norm();
  const Vector3 force = x.tail<3>();
  brace.force = turn * force;
  const BraceObject& on = task_.objects[static_cast<std::size_t>(object)];
  const collision::ShapeDistance touch = constraint::distance(on.surface, brace.place);
  brace.normal = touch.normal;
  brace.gap = touch.gap;
  brace.normal_force = touch.normal.dot(brace.force);
  brace.friction_force = (brace.force - brace.normal_force * touch.normal).norm();
  const Eigen::Index clear =
      static_cast<Eigen::Index>(problem.clear_points.size() * problem.surfaces.size());
  brace.clearance = clear > 0 ? values.tail(clear).minCoeff() : kNoBound;

  const VectorX still = VectorX::Zero(n);
  const auto& moved = equations_.linearise(brace.position, still, still);
  HeldEquilibrium about{moved.by_position, moved.by_rate, moved.by_acceleration, at[1].jacobian,
                        at[0].jacobian};
  for (std::size_t k = 0; k < 3; ++k) {
    about.stiffness -= force[static_cast<Eigen::Index>(k)] * at[1].hessian[k];
  }
  const TipResponse response =
      tip_response(about, task_.hold_frequency, turn.transpose() * brace.normal, on.friction.min);
  if (!response.stable) return result;
  brace.object = object;
  brace.tip_compliance = response.compliance;
  brace.peak_compliance = response.peak_compliance;
  brace.mobility = response.mobility;
  const double spare = on.friction.min * brace.normal_force - brace.friction_force;
  brace.hold_force = std::max(0.0, spare) / response.friction_gain;
  result.reserve = response.friction_gain * task_.hold_force;
  // A held point is at its measured position, so its gap does not count.
  const bool held = problem.held.cols() > 0;
  brace.conditions = {
      check_friction(brace.normal_force, brace.friction_force + result.reserve, on.friction),
      check_stiffness(on.stiffness, task_.arm, task_.stiffness_ratio),
      check_kinematics(held ? 0.0 : brace.gap, brace.clearance, brace.tip_error - task_.tolerance,
                       kGapTolerance)};
  for (const BraceCondition& condition : brace.conditions) {
    if (condition.verdict == BraceCondition::Verdict::holds) ++result.held;
  }
  const bool sticks = reserve_ == Reserve::wished && spare > 0.0 &&
                      brace.conditions[0].verdict != BraceCondition::Verdict::holds;
  if (result.held + (sticks ? 1 : 0) == 3) brace.status = BraceStatus::braced;
  return result;
}

/// Whether the first of two braces is better.
bool BraceSearch::better(const Brace& one, const Brace& other) const {
  if (reserve_ == Reserve::demanded) return one.peak_compliance < other.peak_compliance;
  const auto holds = [](const Brace& brace) {
    return brace.conditions[0].verdict == BraceCondition::Verdict::holds;
  };
  // The first one with the reserve is best, since it is the nearest equilibrium, which the arm
  // reaches.
  return !holds(other) && one.hold_force > other.hold_force;
}

void BraceSearch::keep(const Judged& judged) {
  const Brace& brace = judged.brace;
  if (brace.found()) {
    if (!best_.found() || better(brace, best_)) best_ = brace;
    return;
  }
  const bool nearer =
      nearest_.brace.object < 0 || judged.held > nearest_.held ||
      (judged.held == nearest_.held && brace.hold_force > nearest_.brace.hold_force);
  if (nearer) nearest_ = judged;
}

}  // namespace sinew::plan
