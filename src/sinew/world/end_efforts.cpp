#include "sinew/world/end_efforts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/world/world.hpp"

namespace sinew::world {

namespace {

// Steps whose lengths differ by less, relatively, are equal.
constexpr double kSameStep = 1e-6;

// Two successive changes are those of a smooth effort up to the first ratio, and of a jump from the
// second one on.
constexpr double kSmooth = 1.5, kJump = 3.0;

// Of two changes of one sign the smaller, as far as they are those of a smooth effort.
double limited(double a, double b) {
  if (!(a * b > 0.0)) return 0.0;
  const double least = std::min(std::abs(a), std::abs(b));
  const double ratio = std::max(std::abs(a), std::abs(b)) / least;
  return std::copysign(least, a) * std::clamp((kJump - ratio) / (kJump - kSmooth), 0.0, 1.0);
}

// Whether the effort is whatever holds the motion, at its command or at a limit.
bool holds(const law::ActuatorBlock& block, double effort) {
  if (block.row < 0 || block.owned || block.drive != nullptr) return false;
  if (block.kind == law::CommandKind::motion) {
    return block.effort_min < effort && effort < block.effort_max;
  }
  return block.kind == law::CommandKind::effort && effort != block.value;
}

}  // namespace

EndEfforts::EndEfforts() = default;

void EndEfforts::begin(Formula formula, std::size_t rows) {
  if (std::exchange(formula_, formula) != formula) rate_.assign(rows, 0.0);
  rate_before_.swap(rate_);
  rate_.assign(rows, 0.0);
  change_.assign(rows, 0.0);
}

void EndEfforts::list_held(const World& world, std::span<const double> effort) {
  held_.clear();
  const law::StepProblem& problem = world.problem();
  const contact::RowNumbering& numbering = world.numbering();
  for (const law::BilateralBlock& block : problem.bilaterals) {
    const int row = numbering.model_row_of(block.row);
    held_.push_back({block.row, row, block.motion_scale, -kInfinity, kInfinity});
  }
  for (const law::ActuatorBlock& block : problem.actuators) {
    if (block.row < 0) continue;
    const int row = numbering.model_row_of(block.row);
    if (!holds(block, effort[static_cast<std::size_t>(row)])) continue;
    Held& held = held_.emplace_back(
        Held{block.row, row, block.motion_scale, block.effort_min, block.effort_max});
    if (block.kind == law::CommandKind::motion) continue;
    const bool above = effort[static_cast<std::size_t>(row)] > block.value;  // a stop pushes only
    held.min = above ? block.value : -kInfinity;
    held.max = above ? kInfinity : block.value;
  }
}

// The reported effort keeps the limits of the actuator.
void EndEfforts::take(const Held& held, double effort, double rate, double reach) {
  const auto row = static_cast<std::size_t>(held.model_row);
  rate_[row] = rate;
  const double lacking = reach * limited(rate, rate_before_[row]);
  change_[row] = std::clamp(effort + lacking, held.min, held.max) - effort;
}

void EndEfforts::follow_backward_euler(World& world, std::span<const double> effort,
                                       const mechanics::StepWeights& weights, double step_before) {
  list_held(world, effort);
  if (held_.empty()) return clear();
  const double step = weights.time_step;
  const bool goes_on =
      formula_ == Formula::backward_euler && std::abs(step - step_before) <= kSameStep * step;
  begin(Formula::backward_euler, effort.size());
  now_.resize(static_cast<Eigen::Index>(world.bodies().size()));
  world.bodies().find_acceleration(weights, now_);
  if (goes_on) {
    acceleration_ = now_ - acceleration_;
    world.bodies().apply_mass(acceleration_, force_);
    if (solve_law(world)) {
      for (std::size_t k = 0; k < held_.size(); ++k) {
        take(held_[k], effort[static_cast<std::size_t>(held_[k].model_row)], lacking_[k], 1.0);
      }
    }
  } else {
    std::ranges::fill(rate_before_, 0.0);
  }
  acceleration_.swap(now_);
}

// y of the held rows. Stiffness that is not in A acts as well.
bool EndEfforts::solve_law(World& world) {
  const law::StepProblem& problem = world.problem();
  world.bodies().solve(force_, motion_);
  world.bodies().propose_motion(motion_);
  row_motion_.setZero(problem.delta.size());
  world.bodies().add_row_motions(world.numbering().problem_rows(), row_motion_);
  law_.bilaterals.clear();
  law_.stiffness.clear();
  std::vector<int>& rows = rows_;
  rows.clear();
  for (const Held& own : held_) {
    law_.bilaterals.push_back({static_cast<int>(rows.size()), 0.0, own.motion_scale});
    rows.push_back(own.row);
  }
  for (const law::StiffnessBlock& block : problem.stiffness) {
    if (block.stiffness == 0.0) continue;
    law_.stiffness.push_back({static_cast<int>(rows.size()), block.stiffness});
    rows.push_back(block.row);
  }
  const auto count = static_cast<Eigen::Index>(rows.size());
  law_.compliance.resize(count, count);
  law_.delta_free.resize(count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const int from = rows[static_cast<std::size_t>(j)];
    law_.delta_free[j] = -row_motion_[from];
    for (Eigen::Index i = 0; i < count; ++i) {
      law_.compliance(i, j) = problem.compliance(rows[static_cast<std::size_t>(i)], from);
    }
  }
  law_.delta.setZero(count);
  law_.size = problem.size;
  lacking_.assign(rows.size(), 0.0);
  solver_.begin_step();
  if (solver_.solve(law_, lacking_) == law::LawStatus::failed) return false;
  return std::ranges::all_of(lacking_, [](double own) { return std::isfinite(own); });
}

void EndEfforts::follow_midpoint(const World& world, std::span<const double> effort,
                                 std::span<const double> effort_before, double step,
                                 double step_before) {
  list_held(world, effort);
  if (held_.empty()) return clear();
  const bool goes_on = formula_ == Formula::midpoint && step_before > 0.0;
  begin(Formula::midpoint, effort.size());
  if (!goes_on) return;
  for (const Held& held : held_) {
    const auto row = static_cast<std::size_t>(held.model_row);
    const double rate = 2.0 * (effort[row] - effort_before[row]) / (step + step_before);
    take(held, effort[row], rate, 0.5 * step);
  }
}

void EndEfforts::save(std::vector<double>& numbers) const {
  numbers.clear();
  if (formula_ == Formula::other) return;
  const bool euler = formula_ == Formula::backward_euler;
  numbers.reserve(1 + 2 * change_.size() + static_cast<std::size_t>(acceleration_.size()));
  numbers.push_back(euler ? 1.0 : 2.0);
  numbers.insert(numbers.end(), change_.begin(), change_.end());
  numbers.insert(numbers.end(), rate_.begin(), rate_.end());
  if (euler) numbers.insert(numbers.end(), acceleration_.begin(), acceleration_.end());
}

bool EndEfforts::is_size(std::size_t numbers, std::size_t rows, std::size_t coordinates) {
  return numbers == 0 || numbers == 1 + 2 * rows || numbers == 1 + 2 * rows + coordinates;
}

void EndEfforts::load(std::span<const double> numbers, std::size_t rows, std::size_t coordinates) {
  clear();
  if (numbers.empty()) return;
  const bool euler = numbers[0] == 1.0;
  if (numbers.size() != 1 + 2 * rows + (euler ? coordinates : 0)) return;
  formula_ = euler ? Formula::backward_euler : Formula::midpoint;
  change_.assign(numbers.begin() + 1, numbers.begin() + 1 + static_cast<std::ptrdiff_t>(rows));
  const auto rates = numbers.subspan(1 + rows);
  rate_.assign(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(rows));
  if (!euler) return;
  acceleration_ =
      Eigen::Map<const VectorX>(rates.data() + rows, static_cast<Eigen::Index>(coordinates));
}

}  // namespace sinew::world
