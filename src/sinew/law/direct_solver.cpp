#include "sinew/law/direct_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sinew::law {

namespace {

// Relative size of the term that shares tension among redundant cables.
constexpr double kRedundancy = 1e-12;
// Relative to a row's own compliance: rounding of what held rows leave of it.
constexpr double kCancelled = 1e-14;
// Tolerance of motions, m.
constexpr double kMotionTolerance = 1e-12;
// Relative to the robot's size: motions that are rounding of positions.
constexpr double kRoundingOfMotion = 1e-12;
// Residual up to which a contact solution is used although it misses the tolerance by rounding or
// slow convergence.
constexpr double kUsableResidual = 1e-6;

// Relative to a row's own compliance: smaller values are rounding.
constexpr double kDecided = 1e-10;

constexpr int kMaxDriveRounds = 60;
// Relative to the effort and to what the robot's compliance allows.
constexpr double kDriveTolerance = 1e-13;

constexpr int kMaxFrictionRounds = 300;
constexpr int kPlainRounds = 40;              // before the limits follow more slowly
constexpr double kFrictionTolerance = 1e-12;  // of the largest tension

}  // namespace

DirectSolver::DirectSolver(const qp::ConeSettings& settings) : cone_solver_(settings) {}

void DirectSolver::begin_step() {
  qp_solver_.reset();
  std::ranges::fill(branch_, Branch::pull);
}

LawStatus DirectSolver::solve(const StepProblem& problem, std::span<double> effort) {
  sort(problem, effort);
  if (unreachable_ >= 0) return LawStatus::failed;
  const LawStatus status = problem.capstans.empty() ? solve_with_drives(problem, effort)
                                                    : solve_with_friction(problem, effort);
  return braces_hold(problem, effort) ? status : LawStatus::failed;
}

// Whether every effort that holds a motion by assumption does so.
bool DirectSolver::braces_hold(const StepProblem& problem, std::span<const double> effort) {
  return std::ranges::all_of(problem.actuators, [&](const ActuatorBlock& block) {
    return !block.braced || block.held(effort[static_cast<std::size_t>(block.row)]).has_value();
  });
}

// Sorts rows into given, following and unknown ones. free_ is the motion due to the given ones.
void DirectSolver::sort(const StepProblem& problem, std::span<double> effort) {
  followers_.clear();
  boxes_.clear();
  cones_.clear();
  unknown_.clear();
  unreachable_ = -1;
  free_ = problem.delta_free;
  branch_.resize(problem.actuators.size(), Branch::pull);
  for (std::size_t i = 0; i < problem.actuators.size(); ++i) {
    sort_actuator(problem, static_cast<int>(i), effort);
  }
  first_capstan_ = boxes_.size();
  for (const CapstanBlock& block : problem.capstans) {
    boxes_.push_back({block.row, -1, 0.0, 0.0, block.held});
  }
  for (const BilateralBlock& block : problem.bilaterals) {
    if (problem.compliance(block.row, block.row) != 0.0) {
      followers_.add_held(block.row, block.motion);
    } else {
      effort[static_cast<std::size_t>(block.row)] = 0.0;
    }
  }
  for (const StiffnessBlock& block : problem.stiffness) {
    effort[static_cast<std::size_t>(block.row)] = 0.0;
    if (block.stiffness == 0.0) continue;
    followers_.add_held(block.row, problem.delta[block.row], 1.0 / block.stiffness);
  }
  for (const Box& box : boxes_) unknown_.push_back(box.row);
  for (const ContactBlock& block : problem.contacts) {
    cones_.push_back({static_cast<int>(unknown_.size()), block.friction});
    for (int c = 0; c < 3; ++c) unknown_.push_back(block.row + c);
  }
  list_scales(problem);
}

// What the choice among indeterminate efforts needs to know of the unknowns.
void DirectSolver::list_scales(const StepProblem& problem) {
  unit_.assign(unknown_.size(), 1.0);
  alone_.clear();
  rigid_.clear();
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const int actuator = boxes_[i].actuator;
    if (actuator < 0) continue;
    unit_[i] = problem.actuators[static_cast<std::size_t>(actuator)].motion_scale;
  }
  for (const int row : unknown_) alone_.push_back(std::abs(problem.compliance(row, row)));
  for (const ContactBlock& block : problem.contacts) rigid_.push_back(block.rigid ? 1 : 0);
  scales_ = {unit_, alone_, rigid_, kRoundingOfMotion * problem.size};
}

void DirectSolver::sort_actuator(const StepProblem& problem, int index, std::span<double> effort) {
  const ActuatorBlock& block = problem.actuators[static_cast<std::size_t>(index)];
  if (block.row < 0) return;
  double& own = effort[static_cast<std::size_t>(block.row)];
  const bool moves = problem.compliance(block.row, block.row) != 0.0;
  if (block.braced) {
    if (const auto motion = block.held(own)) return followers_.add_held(block.row, *motion);
  }
  if (!block.owned && block.drive != nullptr) {
    if (moves) return followers_.add_curve(block, problem.delta[block.row]);
    own = block.drive->respond(block.drive_step, problem.delta[block.row]).effort;
  } else if (!block.owned) {
    const Box box = box_of(block, index);
    if (block.holds_motion() && moves) return followers_.add_held(block.row, block.value);
    const bool stops = block.kind != CommandKind::motion &&
                       (std::isfinite(block.motion_min) || std::isfinite(block.motion_max));
    if (moves && (box.lower < box.upper || stops)) return boxes_.push_back(box);
    const double gap = problem.delta_free[block.row] - block.value;
    own = block.kind == CommandKind::effort ? std::clamp(block.value, box.lower, box.upper)
                                            : idle_effort(box, gap * block.motion_scale);
    if (!std::isfinite(own)) unreachable_ = index;
  }
  if (own != 0.0) free_ += own * problem.compliance.col(block.row);
}

// Effort of a row whose motion no effort changes: the lower limit above the commanded motion, the
// upper limit below it, and the least effort at it. Infinite without such a limit.
// @param gap m, motion minus commanded motion.
double DirectSolver::idle_effort(const Box& box, double gap) {
  const bool stays = std::abs(gap) <= kMotionTolerance;
  return std::clamp(stays ? 0.0 : gap > 0.0 ? box.lower : box.upper, box.lower, box.upper);
}

// lambda in [lower, upper]; delta = motion strictly between, >= motion at `lower`, <= motion at
// `upper`.
DirectSolver::Box DirectSolver::box_of(const ActuatorBlock& block, int index) const {
  Box box{block.row, index, block.effort_min, block.effort_max, block.value};
  if (block.kind != CommandKind::motion) {
    if (branch_[static_cast<std::size_t>(index)] == Branch::hold) {
      box.lower = block.value;
      box.motion = block.motion_min;
      box.stop = -1;
    } else {
      // Without a limit of its motion only the command itself is possible.
      const bool stops = !std::isinf(block.motion_max);
      if (!stops) box.lower = block.value;
      box.upper = block.value;
      box.motion = stops ? block.motion_max : 0.0;
      box.stop = stops ? 1 : 0;
    }
  }
  box.upper = std::max(box.lower, box.upper);
  return box;
}

LawStatus DirectSolver::solve_with_friction(const StepProblem& problem, std::span<double> effort) {
  limits_.resize(problem.capstans.size());
  follow_tensions(problem, effort, 1.0);
  for (int round = 0; round < kMaxFrictionRounds; ++round) {
    if (solve_with_drives(problem, effort) == LawStatus::failed) return LawStatus::failed;
    if (follow_tensions(problem, effort, round < kPlainRounds ? 1.0 : 0.5)) break;
  }
  return LawStatus::solved;
}

// Returns whether the limits agree with the tensions; if not, moves them the fraction `share`
// there.
bool DirectSolver::follow_tensions(const StepProblem& problem, std::span<const double> effort,
                                   double share) {
  const std::span<Box> capstans = std::span(boxes_).subspan(first_capstan_, limits_.size());
  double off = 0.0, largest = 0.0;
  std::size_t k = 0;
  for_each_guide(problem, effort, [&](const CapstanBlock& block, const GuideTension& tension) {
    const double lower = tension.lower(block), upper = tension.upper(block);
    largest = std::max(largest, tension.largest());
    off = std::max({off, std::abs(upper - capstans[k].upper), std::abs(lower - capstans[k].lower)});
    limits_[k++] = {lower, upper};
  });
  if (off <= kFrictionTolerance * largest) return true;
  for (k = 0; k < limits_.size(); ++k) {
    const auto& [lower, upper] = limits_[k];
    capstans[k].lower += share * (lower - capstans[k].lower);
    capstans[k].upper += share * (upper - capstans[k].upper);
  }
  return false;
}

LawStatus DirectSolver::solve_with_drives(const StepProblem& problem, std::span<double> effort) {
  const auto count = static_cast<Eigen::Index>(unknown_.size());
  auto compliance = compliance_.shape(count, count);
  auto motion = motion_.shape(count, 1);
  x_.resize(unknown_.size());
  for (std::size_t i = 0; i < x_.size(); ++i) {
    x_[i] = effort[static_cast<std::size_t>(unknown_[i])];
  }
  const bool curves = followers_.has_curves();
  for (int round = 0; round < kMaxDriveRounds; ++round) {
    followers_.take_out(problem, free_, unknown_, compliance, motion.col(0));
    unite_twins(problem, compliance, motion);
    settle_decided(problem, compliance, motion);
    const LawStatus status = solve_blocks(problem);
    if (status == LawStatus::failed) return status;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      effort[static_cast<std::size_t>(unknown_[i])] = x_[i];
    }
    const double left = followers_.close(problem, free_, unknown_, effort);
    if (!curves || left <= kDriveTolerance) break;
  }
  return LawStatus::solved;
}

// Redundant rows (a hinge's motor, brake and limit) stay redundant after the elimination of held
// rows, but each has its own rounding: for a bracket on a weld 1e-5 of W is left, and a motor and a
// brake would form an indefinite matrix.
void DirectSolver::unite_twins(const StepProblem& problem, Eigen::Map<MatrixX> compliance,
                               Eigen::Map<MatrixX> motion) {
  const VectorX& free = problem.delta_free;
  for (std::size_t i = 1; i < boxes_.size(); ++i) {
    const int row = boxes_[i].row;
    const auto repeats = [&](const Box& other) {
      return free[row] == free[other.row] &&
             problem.compliance.col(row) == problem.compliance.col(other.row);
    };
    const auto twin = std::find_if(boxes_.begin(), boxes_.begin() + static_cast<int>(i), repeats);
    if (twin == boxes_.begin() + static_cast<int>(i)) continue;
    const auto own = static_cast<Eigen::Index>(i), first = twin - boxes_.begin();
    compliance.row(own) = compliance.row(first);
    compliance.col(own) = compliance.col(first);
    motion(own, 0) = motion(first, 0);
  }
}

// If held rows determine the motion of a row (a brake beside a motor that holds the same hinge),
// only rounding is left of its compliance. Its effort then moves nothing, and follows from its
// motion, see idle_effort().
void DirectSolver::settle_decided(const StepProblem& problem, Eigen::Map<MatrixX> compliance,
                                  Eigen::Map<MatrixX> motion) {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    Box& box = boxes_[i];
    const auto k = static_cast<Eigen::Index>(i);
    // Negative if an anchor replaces the missing stiffness of a body held only by joints.
    const double alone = std::abs(problem.compliance(box.row, box.row));
    box.rounding = kCancelled * alone;
    box.decided = compliance(k, k) <= kDecided * alone;
    if (!box.decided) continue;
    const double gap = motion(k, 0) - box.motion;
    const double effort = idle_effort(box, gap);
    if (!std::isfinite(effort)) {  // no solution: the held motion is beyond a stop
      box.decided = false;
      continue;
    }
    // Replaces the row by an uncoupled problem with this solution, well beyond a limit if it is
    // one.
    const bool stays = std::abs(gap) <= kMotionTolerance;
    const double beyond = stays ? 0.0 : std::copysign(problem.size, gap);
    compliance.row(k).setZero();
    compliance.col(k).setZero();
    compliance(k, k) = alone;
    motion(k, 0) = box.motion - alone * effort + beyond;
  }
}

LawStatus DirectSolver::solve_blocks(const StepProblem& problem) {
  const Eigen::Map<const MatrixX> compliance = std::as_const(compliance_).view();
  const std::size_t max_rounds = 2 * boxes_.size() + 2;
  for (std::size_t round = 0; round < max_rounds; ++round) {
    const LawStatus status = cones_.empty() ? solve_boxes(compliance) : solve_cones(compliance);
    if (status == LawStatus::failed) return status;
    if (!switch_branches(problem, compliance)) return LawStatus::solved;
  }
  return LawStatus::failed;
}

// A commanded effort with a limited motion is treated as given until the motion passes the limit. A
// distant stop on a row that something else moves as well (a brake, a motor of the same joint)
// would make the program nearly singular, with a gradient beside which the others are rounding.
LawStatus DirectSolver::solve_boxes(const Eigen::Map<const MatrixX>& compliance) {
  if (boxes_.empty()) return LawStatus::solved;
  for (Box& box : boxes_) box.waits = box.stop != 0 && box.lower < box.upper;
  bool settled = false;
  while (!settled) {
    if (solve_program(compliance) == LawStatus::failed) return LawStatus::failed;
    settled = true;
    const auto motion = motion_.view();
    const Eigen::Map<const VectorX> x(x_.data(), static_cast<Eigen::Index>(x_.size()));
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      Box& box = boxes_[i];
      if (!box.waits) continue;
      const auto k = static_cast<Eigen::Index>(i);
      const double beyond = motion(k, 0) + compliance.row(k).dot(x) - box.motion;
      box.waits = box.stop * beyond <= 0.0;
      settled = settled && box.waits;
    }
  }
  lessen_boxes(compliance);
  return LawStatus::solved;
}

// Redundant ropes: of the tensions that cause the same motion, those of least norm. The term that
// makes the program definite is as small as rounding of the ropes' lengths, so it does not choose.
void DirectSolver::lessen_boxes(const Eigen::Map<const MatrixX>& compliance) {
  if (boxes_.size() < 2) return;
  list_boxes();
  const qp::ConeProblem problem{compliance, std::as_const(motion_).view().col(0), cone_boxes_, {}};
  if (choice_.find(problem, scales_)) choice_.lessen(problem.offset, x_);
}

// A given effort is a box without room.
void DirectSolver::list_boxes() {
  cone_boxes_.clear();
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Box& box = boxes_[i];
    double lower = box.lower, upper = box.upper;
    if (box.waits) (box.stop < 0 ? upper : lower) = box.stop < 0 ? box.lower : box.upper;
    cone_boxes_.push_back({static_cast<int>(i), lower, upper, box.motion});
  }
}

// Given efforts go to the right-hand side: the compliance of their rows, which may be that of a
// cable that moves nothing, has no influence.
LawStatus DirectSolver::solve_program(const Eigen::Map<const MatrixX>& compliance) {
  const auto count = static_cast<Eigen::Index>(boxes_.size());
  if (program_.gradient.size() != count) {
    program_ = qp::QuadraticProgram::sized(static_cast<int>(count), 0);
    qp_solver_ = qp::QpSolver(static_cast<int>(count), 0);
    scale_.resize(count);
  }
  const auto motion = motion_.view();
  const auto is_given = [&](Eigen::Index k) {
    return boxes_[static_cast<std::size_t>(k)].is_given();
  };
  const auto given = [&](const Box& box) { return box.stop < 0 ? box.lower : box.upper; };
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool scaled = !is_given(i) && compliance(i, i) > 0.0;
    scale_[i] = scaled ? 1.0 / std::sqrt(compliance(i, i)) : 1.0;
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    const Box& box = boxes_[static_cast<std::size_t>(j)];
    double moved = motion(j, 0) - box.motion;
    for (Eigen::Index i = 0; i < count; ++i) {
      const bool apart = is_given(i) || is_given(j);
      program_.hessian(i, j) = apart ? 0.0 : scale_[i] * scale_[j] * compliance(i, j);
      if (is_given(i)) moved += compliance(j, i) * given(boxes_[static_cast<std::size_t>(i)]);
    }
    program_.hessian(j, j) += is_given(j) ? 1.0 : kRedundancy;
    program_.gradient[j] = is_given(j) ? -given(box) : scale_[j] * moved;
    program_.lower[j] = (is_given(j) ? given(box) : box.lower) / scale_[j];
    program_.upper[j] = (is_given(j) ? given(box) : box.upper) / scale_[j];
  }
  const qp::QpResult& result = qp_solver_.solve(program_);
  if (result.status == qp::QpStatus::not_convex) solve_rounded_program();
  if (result.status != qp::QpStatus::optimal) return LawStatus::failed;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    // Scaling must not blur a limit: the tension of a slack cable is exactly zero.
    x_[i] = scale_[k] * result.x[k];
    if (is_given(k)) {
      x_[i] = given(boxes_[i]);
    } else if (result.x[k] <= program_.lower[k]) {
      x_[i] = boxes_[i].lower;
    } else if (result.x[k] >= program_.upper[k]) {
      x_[i] = boxes_[i].upper;
    }
  }
  return LawStatus::solved;
}

// Rounding has made the Hessian indefinite. The term that makes it definite again moves held rows;
// one proximal step (Rockafellar, SIAM J. Control Optim. 14 (1976) 877) squares that error.
void DirectSolver::solve_rounded_program() {
  const auto weight = [&](std::size_t i) {
    const double scale = scale_[static_cast<Eigen::Index>(i)];
    return boxes_[i].is_given() ? 0.0 : boxes_[i].rounding * scale * scale;
  };
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    program_.hessian(k, k) += weight(i);
  }
  const qp::QpResult& result = qp_solver_.solve(program_);
  if (result.status != qp::QpStatus::optimal) return;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    program_.gradient[k] -= weight(i) * result.x[k];
  }
  qp_solver_.solve(program_);
}

// Where rigid bodies make the forces indeterminate, they are chosen before or after the solution,
// see qp::ForceChoice. A solution from chosen forces costs little more than its check.
LawStatus DirectSolver::solve_cones(const Eigen::Map<const MatrixX>& compliance) {
  list_boxes();
  auto offset = motion_.view().col(0);
  const qp::ConeProblem problem{compliance, offset, cone_boxes_, cones_};
  if (!choice_.find(problem, scales_)) return solve_cones(problem);
  choice_.rest(offset, x_, false);
  if (choice_.any_moves_alone()) {
    cone_solver_.solve({choice_.regularised(), offset, cone_boxes_, cones_}, x_);
    choice_.rest(offset, x_, true);
    choice_.align(offset, x_);
  }
  const LawStatus status = solve_cones(problem);
  if (status == LawStatus::failed || !choice_.any_moves()) return status;
  choice_.lessen(offset, x_);
  return solve_cones(problem);
}

LawStatus DirectSolver::solve_cones(const qp::ConeProblem& problem) {
  const qp::ConeResult& result = cone_solver_.solve(problem, x_);
  const bool usable =
      result.status == qp::ConeStatus::solved ||
      (result.status == qp::ConeStatus::iteration_limit && result.residual <= kUsableResidual);
  return usable ? LawStatus::solved : LawStatus::failed;
}

// Switches the branch of a commanded effort whose motion passed the far limit.
bool DirectSolver::switch_branches(const StepProblem& problem,
                                   const Eigen::Map<const MatrixX>& compliance) {
  const auto motion = motion_.view();
  const Eigen::Map<const VectorX> x(x_.data(), static_cast<Eigen::Index>(x_.size()));
  bool switched = false;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    Box& box = boxes_[i];
    if (box.actuator < 0) continue;
    const ActuatorBlock& block = problem.actuators[static_cast<std::size_t>(box.actuator)];
    if (block.kind == CommandKind::motion || box.decided) continue;
    const auto k = static_cast<Eigen::Index>(i);
    const double there = motion(k, 0) + compliance.row(k).dot(x);
    const double tolerance = kMotionTolerance / block.motion_scale;
    Branch& branch = branch_[static_cast<std::size_t>(box.actuator)];
    const Branch before = branch;
    if (branch == Branch::pull && there < block.motion_min - tolerance) branch = Branch::hold;
    if (before == Branch::hold && there > block.motion_max + tolerance) branch = Branch::pull;
    if (branch == before) continue;
    box = box_of(block, box.actuator);
    switched = true;
  }
  return switched;
}

namespace {

// A (3n, 3n) matrix without its blocks of zeros.
Eigen::SparseMatrix<double> without_zeros(const Eigen::Ref<const MatrixX>& dense) {
  const Eigen::Index count = dense.rows();
  Eigen::SparseMatrix<double> sparse(count, count);
  std::vector<int> blocks(static_cast<std::size_t>(count), 0);  // entries of each column
  const auto is_zero = [&](Eigen::Index i, Eigen::Index j) {
    return dense.block<3, 3>(i, j).cwiseAbs().maxCoeff() == 0.0;
  };
  for (Eigen::Index j = 0; j < count; j += 3) {
    for (Eigen::Index i = 0; i < count; i += 3) {
      if (is_zero(i, j)) continue;
      for (Eigen::Index c = j; c < j + 3; ++c) blocks[static_cast<std::size_t>(c)] += 3;
    }
  }
  sparse.reserve(blocks);
  for (Eigen::Index j = 0; j < count; j += 3) {
    for (Eigen::Index i = 0; i < count; i += 3) {
      if (is_zero(i, j)) continue;
      for (Eigen::Index c = j; c < j + 3; ++c) {
        for (Eigen::Index r = i; r < i + 3; ++r) sparse.insert(r, c) = dense(r, c);
      }
    }
  }
  sparse.makeCompressed();
  return sparse;
}

}  // namespace

// Followers are already eliminated from compliance_ and motion_; boxes that hold a motion are
// eliminated here.
ContactProblem DirectSolver::contact_problem() const {
  const auto count = static_cast<Eigen::Index>(3 * cones_.size());
  ContactProblem result{
      Eigen::SparseMatrix<double>(count, count), VectorX(count), {}, VectorX(count)};
  if (cones_.empty()) return result;
  const auto all = compliance_.view();
  VectorX free = motion_.view().col(0);
  Followers held;
  bool holds_any = false;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Box& box = boxes_[i];
    const auto row = static_cast<Eigen::Index>(i);
    const bool holds = x_[i] > box.lower && x_[i] < box.upper && all(row, row) > 0.0;
    if (holds) held.add_held(static_cast<int>(i), box.motion);
    if (!holds) free += x_[i] * all.col(row);
    holds_any = holds_any || holds;
  }
  result.motion = free.tail(count);
  if (holds_any) {
    MatrixX left(count, count);
    std::vector<int> rows(static_cast<std::size_t>(count));
    std::iota(rows.begin(), rows.end(), static_cast<int>(boxes_.size()));
    StepProblem copy;
    copy.compliance = all;
    held.take_out(copy, free, rows, left, result.motion);
    result.compliance = without_zeros(left);
  } else {
    result.compliance = without_zeros(all.bottomRightCorner(count, count));
  }
  result.effort = Eigen::Map<const VectorX>(x_.data() + boxes_.size(), count);
  for (const qp::ConeBlock& cone : cones_) result.friction.push_back(cone.friction);
  return result;
}

}  // namespace sinew::law
