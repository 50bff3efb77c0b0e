#include "sinew/law/step_problem.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/linalg/dense_factor.hpp"
#include "sinew/qp/cone_solver.hpp"

namespace sinew::law {

namespace {

// Relative difference below which an effort is at its limit.
constexpr double kAtLimit = 1e-9;

bool at_limit(double effort, double limit) {
  if (!std::isfinite(limit)) return false;
  return std::abs(effort - limit) <= kAtLimit * std::max(std::abs(effort), std::abs(limit));
}

// Violation of a commanded motion by `gap`: an effort at its lower limit allows a larger motion,
// one at its upper limit a smaller one.
double box_miss(double gap, bool at_lower, bool at_upper) {
  if (at_lower && at_upper) return 0.0;
  if (at_lower) return std::max(0.0, -gap);
  if (at_upper) return std::max(0.0, gap);
  return std::abs(gap);
}

double miss(const ActuatorBlock& block, double effort, double motion) {
  const bool at_lower = effort <= block.effort_min, at_upper = effort >= block.effort_max;
  if (block.kind == CommandKind::motion) return box_miss(motion - block.value, at_lower, at_upper);
  if (effort < block.value && std::isfinite(block.motion_max)) {
    return box_miss(motion - block.motion_max, at_lower, false);
  }
  if (effort > block.value && std::isfinite(block.motion_min)) {
    return box_miss(motion - block.motion_min, false, at_upper);
  }
  if (block.effort_min == block.effort_max) return 0.0;
  return std::max({0.0, at_lower ? 0.0 : motion - block.motion_max,
                   at_upper ? 0.0 : block.motion_min - motion});
}

// Violation of the limits of motion for an effort that a controller chose.
double limit_miss(const ActuatorBlock& block, double effort, double motion) {
  if (motion > block.motion_max && effort > block.effort_min) return motion - block.motion_max;
  if (motion < block.motion_min && effort < block.effort_max) return block.motion_min - motion;
  return 0.0;
}

// Distance from a curve as a motion: along the curve, or along the robot's own compliance if the
// curve is flat.
double curve_miss(const StepProblem& problem, const ActuatorBlock& block, double effort) {
  const auto at = block.drive->respond(block.drive_step, problem.delta[block.row]);
  const double own = problem.compliance(block.row, block.row);
  const double steepness = std::max(-at.slope, own > 0.0 ? 1.0 / own : 0.0);
  return steepness > 0.0 ? std::abs(effort - at.effort) / steepness : 0.0;
}

double contact_miss(const StepProblem& problem, const ContactBlock& block,
                    std::span<const double> effort) {
  const double scale = problem.compliance.diagonal().segment<3>(block.row).sum() / 3.0;
  if (!(scale > 0.0)) return 0.0;
  const Eigen::Map<const Vector3> force(effort.data() + block.row);
  const Vector3 motion = problem.delta.segment<3>(block.row);
  return scale * qp::cone_residual(force, motion, block.friction, scale);
}

// Distance from the graph of a guide's friction as a motion, with the robot's own compliance c:
// c |f - [f - slip/c]|, [.] the nearest effort within the limits. A guide that slides may end just
// inside limits that have moved with the robot; that is a small miss, however far it slid.
double guide_miss(const StepProblem& problem, const CapstanBlock& block,
                  const GuideTension& tension, double effort) {
  const double own = problem.compliance(block.row, block.row);
  if (!(own > 0.0)) return 0.0;
  const double pulls = effort - (problem.delta[block.row] - block.held) / own;
  return own * std::abs(effort - std::clamp(pulls, tension.lower(block), tension.upper(block)));
}

}  // namespace

void ActuatorBlock::hold_effort(double effort) {
  owned = false;
  drive = nullptr;
  kind = CommandKind::effort;
  value = effort_min = effort_max = effort;
  motion_min = -kInfinity;
  motion_max = kInfinity;
}

void ActuatorBlock::command_effort(double effort) {
  owned = false;
  drive = nullptr;
  kind = CommandKind::effort;
  value = effort;
}

bool ActuatorBlock::holds_motion() const {
  return !owned && drive == nullptr && kind == CommandKind::motion && std::isinf(effort_min) &&
         std::isinf(effort_max);
}

std::optional<double> ActuatorBlock::held(double effort) const {
  if (owned || drive != nullptr || kind == CommandKind::input) return {};
  if (at_limit(effort, effort_min) || at_limit(effort, effort_max)) return {};
  if (effort < effort_min || effort > effort_max) return {};
  if (kind == CommandKind::motion) return value;
  if (at_limit(effort, value)) return {};
  const double stop = effort < value ? motion_max : motion_min;
  return std::isfinite(stop) ? std::optional(stop) : std::nullopt;
}

double violation(const StepProblem& problem, std::span<const double> effort, LawStatus law) {
  const auto of = [&](int row) { return effort[static_cast<std::size_t>(row)]; };
  double worst = 0.0;
  for (const ActuatorBlock& block : problem.actuators) {
    if (block.row < 0 || (block.owned && law == LawStatus::limits_conflict)) continue;
    const double lambda = of(block.row), motion = problem.delta[block.row];
    const double own = block.owned              ? limit_miss(block, lambda, motion)
                       : block.drive != nullptr ? curve_miss(problem, block, lambda)
                                                : miss(block, lambda, motion);
    worst = std::max(worst, block.motion_scale * own);
  }
  for_each_guide(problem, effort, [&](const CapstanBlock& block, const GuideTension& tension) {
    worst = std::max(worst, guide_miss(problem, block, tension, of(block.row)));
  });
  for (const ContactBlock& block : problem.contacts) {
    worst = std::max(worst, contact_miss(problem, block, effort));
  }
  for (const BilateralBlock& block : problem.bilaterals) {
    const double gap = problem.delta[block.row] - block.motion;
    worst = std::max(worst, block.motion_scale * std::abs(gap));
  }
  return worst;
}

void append_joints(const StepProblem& problem, std::vector<HeldRow>& held) {
  for (const BilateralBlock& block : problem.bilaterals) held.push_back({block.row, 0.0});
  for (const StiffnessBlock& block : problem.stiffness) {
    if (block.stiffness != 0.0) held.push_back({block.row, 1.0 / block.stiffness});
  }
}

// The diagonal W + C of an anchor may vanish; W then gives the size of its entries.
HeldCompliance held_compliance(const StepProblem& problem, std::span<const HeldRow> held) {
  const auto rows = static_cast<Eigen::Index>(held.size());
  HeldCompliance result{MatrixX(rows, rows), VectorX(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    const HeldRow& own = held[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < rows; ++j) {
      result.matrix(i, j) = problem.compliance(own.row, held[static_cast<std::size_t>(j)].row);
    }
    const double alone = std::abs(result.matrix(i, i));
    result.matrix(i, i) += own.compliance;
    const double size = std::max(alone, std::abs(result.matrix(i, i)));
    result.scale[i] = size > 0.0 ? 1.0 / std::sqrt(size) : 1.0;
  }
  result.matrix.array().colwise() *= result.scale.array();
  result.matrix.array().rowwise() *= result.scale.transpose().array();
  return result;
}

int negative_directions(int negative_pivots, int negative, std::span<const HeldRow> held) {
  const auto own = std::ranges::count_if(held, [](auto& row) { return row.compliance < 0.0; });
  return negative_pivots - negative + static_cast<int>(own);
}

bool stabilised(const StepProblem& problem, int negative_pivots) {
  std::vector<HeldRow> held;
  for (const ActuatorBlock& block : problem.actuators) {
    if (block.braced || block.holds_motion()) held.push_back({block.row, 0.0});
    if (block.owned || block.drive == nullptr) continue;
    const auto at = block.drive->respond(block.drive_step, problem.delta[block.row]);
    if (at.slope < 0.0) held.push_back({block.row, -1.0 / at.slope});  // a flat one holds nothing
  }
  append_joints(problem, held);
  if (held.empty()) return negative_pivots == 0;
  const auto own = held_compliance(problem, held);
  const int negative = linalg::spectral_inverse(own.matrix).negative;
  return negative_directions(negative_pivots, negative, held) <= 0;
}

bool brace(StepProblem& problem, std::span<const double> effort, int negative_pivots) {
  bool any = false;
  for (ActuatorBlock& block : problem.actuators) {
    if (block.row < 0 || block.holds_motion()) continue;
    const bool moves = problem.compliance(block.row, block.row) != 0.0;
    block.braced = moves && block.held(effort[static_cast<std::size_t>(block.row)]).has_value();
    any = any || block.braced;
  }
  if (any && stabilised(problem, negative_pivots)) return true;
  release_braces(problem);
  return false;
}

void release_braces(StepProblem& problem) {
  for (ActuatorBlock& block : problem.actuators) block.braced = false;
}

}  // namespace sinew::law
