// Newton's method on the equations that the projection onto cones and boxes leaves. With
// s = r - u/w, a contact has
//   s_n <= 0:                     r = 0
//   s_n > 0, |s_t| <= mu s_n:     u = 0
//   s_n > 0, |s_t| >  mu s_n:     u_n = 0,  r_t - mu s_n s_t/|s_t| = 0
// (Alart & Curnier 1991, with the projection of the augmented normal effort), and a box
//   x = its limit, if x - (y - target)/w is beyond it, else y = target.
// Blocks with a given x leave the system; the equations of the others are linearised. The residual
// may rise while blocks change branch, and x may leave the cones: projecting it back in between
// would spoil Newton's steps. The proximal term a D (cone_solver.hpp) is added to the matrix only,
// since it is zero at the present iterate.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "sinew/qp/cone_island.hpp"

namespace sinew::qp {

namespace {

constexpr int kMaxNewtonSteps = 30, kMaxVainSteps = 20, kMaxEarlyVain = 3, kMaxUsableVain = 4;
// The proximal term relative to the diagonal: a multiple of the relative residual, and at least so
// much that the undetermined part of redundant contacts does not grow out of rounding. A larger
// term takes more steps and fails less often. If W is regular but stiff, next to nothing is best.
struct Proximal {
  double share, least, most;
  double operator()(double residual) const { return std::clamp(share * residual, least, most); }
};
// After a step that left at most this part of the residual, the next step reuses its factors if it
// has the same unknowns: only the proximal term and the directions of slips differ.
constexpr double kMuchGained = 0.1;
constexpr double kMinSmoothing = 1e-9;
constexpr Proximal kProximal[] = {
    {0.1, 1e-6, 1e-2}, {1.0, 1e-6, 0.1}, {10.0, 1e-6, 0.1}, {1.0, kMinSmoothing, 0.1}};  // in turn
// Up to this many rows, this many steps with the smallest term are tried first: they are cheap.
constexpr int kPlainRows = 96, kPlainSteps = 12;
// Regularised problems: the term decreases to kLastShift of the diagonal by the factor kNextShift
// each, or by less if Newton fails to converge. The tolerance of each is relative to its term.
constexpr double kLastShift = 1e-12, kNextShift = 0.1, kMaxFactor = 0.8;
constexpr double kShiftTolerance = 1e-3;
constexpr int kMaxShiftedSteps = 20;

}  // namespace

bool ConeIsland::newton(const ConePart& part) {
  static_assert(std::size(kProximal) == kNewtonWays);
  const std::size_t tries = newton_tries_++;
  const double tolerance = settings_.tolerance;
  if (tries == 0 && x_.size() <= kPlainRows) {
    if (newton_steps(part, {kPlainSteps, kMaxVainSteps}, tolerance,
                     [](double) { return kMinSmoothing; })) {
      return true;
    }
  }
  if (tries == std::size(kProximal)) return follow_regularised(part);
  return newton_steps(part, {kMaxNewtonSteps, kMaxVainSteps}, tolerance,
                      kProximal[tries % std::size(kProximal)]);
}

// For cheap steps or a start near the solution: stops when steps gain nothing.
bool ConeIsland::newton_early(const ConePart& part) {
  return newton_steps(part, {kMaxNewtonSteps, kMaxEarlyVain}, settings_.tolerance, kProximal[0]);
}

// Tikhonov regularisation: each problem with W + a D has one solution, which Newton finds from that
// of the larger a. As a -> 0 they lead to a solution of least size, whatever the order of the
// contacts. This takes more steps than the proximal method, and succeeds where that one cycles.
bool ConeIsland::follow_regularised(const ConePart& part) {
  linalg::grow(start_, best_.size());
  std::copy_n(x_.data(), x_.size(), start_.data());
  const double least = result_.residual;
  x_.setZero();
  settle_into_blocks(part.problem);
  double reached = 1.0, factor = kNextShift;
  while (reached > kLastShift && factor < kMaxFactor) {
    shift_ = reached * factor;
    measure_motion(part);
    judge(part);
    const double tolerance = std::max(settings_.tolerance, kShiftTolerance * shift_);
    if (!newton_steps(part, {kMaxShiftedSteps, kMaxVainSteps}, tolerance,
                      [&](double) { return shift_; })) {
      factor = std::sqrt(factor);
      continue;
    }
    reached = std::exchange(shift_, 0.0);
    measure_motion(part);
    if (judge(part) <= settings_.tolerance) return true;
    factor = std::max(factor * factor, kNextShift);
  }
  shift_ = 0.0;
  measure_motion(part);
  judge(part);
  if (!(result_.residual < least)) {
    std::copy_n(start_.data(), x_.size(), x_.data());
    measure_motion(part);
    judge(part);
  }
  return false;
}

// (W + a D) x in place of W x, for the iterate of follow_regularised().
void ConeIsland::add_shifted(const ConePart& part) {
  const auto add = [&](int row, double own, double scale) {
    motion_[row] += proximal_term(own, 1.0 / std::sqrt(scale), shift_) * x_[row];
  };
  const auto& w = part.problem.matrix;
  const std::size_t boxes = part.problem.boxes.size();
  for (std::size_t k = 0; k < boxes; ++k) {
    const int row = part.problem.boxes[k].row;
    if (box_scale_[k] > 0.0) add(row, box_scale_[k], box_scale_[k]);
  }
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
    const int row = part.problem.cones[k].row;
    if (!usable(k)) continue;
    for (int c = 0; c < 3; ++c) {
      const double own = part.blocks == nullptr
                             ? w(row + c, row + c)
                             : part.blocks->diagonal(static_cast<int>(boxes + k))(c, c);
      add(row + c, own, scale_[k]);
    }
  }
}

// Takes Newton steps. Without success the iterate is the best of them.
// @param proximal function of the relative residual: the proximal term.
bool ConeIsland::newton_steps(const ConePart& part, Patience patience, double tolerance,
                              auto&& proximal) {
  const auto keep = [&] { std::copy_n(x_.data(), x_.size(), best_.data()); };
  keep();
  double least = result_.residual;
  bool usable = is_usable(part);
  keeps_factors_ = false;
  for (int step = 0, vain = 0; step < patience.steps && vain < patience.vain; ++step, ++vain) {
    poll();
    const double relative = miss_.distance / std::max(miss_.effort, 1e-300);
    const double before = result_.residual;
    if (!newton_step(part, proximal(relative))) break;
    const double residual = judge(part);
    keeps_factors_ = residual <= kMuchGained * before;
    if (residual < least) {
      least = residual;
      usable = is_usable(part);
      vain = 0;
      keep();
    }
    if (residual <= tolerance) {
      settle_into_blocks(part.problem);
      measure_motion(part);
      if (judge(part) <= tolerance) return true;
    }
    if (!std::isfinite(residual)) break;
    if (usable && vain >= kMaxUsableVain) break;
  }
  std::copy_n(best_.data(), x_.size(), x_.data());
  settle_into_blocks(part.problem);
  measure_motion(part);
  judge(part);
  return false;
}

bool ConeIsland::newton_step(const ConePart& part, double proximal) {
  const int count = choose_unknowns(part);
  if (part.blocks == nullptr && count > settings_.newton_limit) return false;
  measure_motion(part);
  form_right(part);
  right_.head(count).array() *= row_scale_.head(count).array();
  if (count > 0) {
    const bool solved = part.blocks != nullptr ? solve_sparse(part, count, proximal)
                                               : solve_dense(part, count, proximal);
    if (!solved) return false;
  }
  ++result_.newton_steps;
  move_unknowns(part, count);
  measure_motion(part);
  return true;
}

// Sets x of the blocks that leave the system. The rows of the others are the unknowns, those of
// slips last.
int ConeIsland::choose_unknowns(const ConePart& part) {
  const ConeProblem& problem = part.problem;
  int count = 0;
  last_.clear();
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    const BoxBlock& box = problem.boxes[k];
    box_at_[k] = -1;
    if (!(box_scale_[k] > 0.0)) continue;
    const double aim = x_[box.row] - (motion_[box.row] - box.target) / box_scale_[k];
    if (aim <= box.lower || aim >= box.upper) {
      x_[box.row] = aim <= box.lower ? box.lower : box.upper;
      continue;
    }
    unknown_row_[static_cast<std::size_t>(count)] = box.row;
    row_scale_[count] = 1.0 / std::sqrt(box_scale_[k]);
    box_at_[k] = count++;
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    const int row = problem.cones[k].row;
    cone_at_[k] = -1;
    if (!usable(k) || x_[row] - motion_[row] / scale_[k] <= 0.0) {
      x_.segment<3>(row).setZero();
      continue;
    }
    branches_[k] = branch(part, k);
    if (branches_[k].symmetric()) {
      count = add_unknowns(problem, k, count);
    } else {
      last_.push_back(k);
    }
  }
  symmetric_ = count;
  for (const std::size_t k : last_) count = add_unknowns(problem, k, count);
  return count;
}

int ConeIsland::add_unknowns(const ConeProblem& problem, std::size_t number, int count) {
  const int row = problem.cones[number].row, own = branches_[number].unknowns();
  cone_at_[number] = count;
  if (own == 1) x_.segment<2>(row + 1) = x_[row] * branches_[number].along();
  row_scale_.segment(count, own).setConstant(1.0 / std::sqrt(scale_[number]));
  for (int c = 0; c < own; ++c) unknown_row_[static_cast<std::size_t>(count + c)] = row + c;
  return count + own;
}

// d(r_t - mu s_n e) = dr_t - mu e ds_n - (mu s_n/|s_t|)(I - e e^T) ds_t, e = s_t/|s_t|,
// ds = dr - du/w; multiplied by w, so that all rows are motions.
// The last term is small if a cone slides far: its direction is then held during a step.
ConeIsland::Branch ConeIsland::branch(const ConePart& part, std::size_t number) const {
  const int row = part.problem.cones[number].row;
  const double mu = part.problem.cones[number].friction, w = scale_[number];
  const Vector3 r = x_.segment<3>(row), u = motion_.segment<3>(row);
  const Vector3 s = r - u / w;
  Branch result;
  result.motion = u;
  result.right = -u;
  const double far = s.tail<2>().norm();
  if (far <= mu * s[0] && mu > 0.0) return result;
  result.slips = true;
  result.weight = w;
  Eigen::Vector2d e = Eigen::Vector2d::Zero();
  if (far > 0.0) e = s.tail<2>() / far;
  const double share = far > 0.0 ? mu * s[0] / far : 0.0;
  result.friction = mu;
  result.direction = e;
  result.share = share;
  result.holds = part.blocks == nullptr && share <= held_share_;
  result.effort = r.tail<2>();
  result.across = share * (Eigen::Matrix2d::Identity() - e * e.transpose());
  result.right.tail<2>() = -w * (r.tail<2>() - mu * s[0] * e);
  return result;
}

Vector3 ConeIsland::Branch::act(const Vector3& du) const {
  Vector3 result;
  result[0] = du[0];
  result.tail<2>() = friction * direction * du[0] + across * du.tail<2>();
  return result;
}

Matrix3 ConeIsland::Branch::own() const {
  Matrix3 result = Matrix3::Zero();
  result.block<2, 1>(1, 0) = -(weight * friction * direction);
  result.block<2, 2>(1, 1) = weight * (Eigen::Matrix2d::Identity() - across);
  return result;
}

void ConeIsland::form_right(const ConePart& part) {
  const ConeProblem& problem = part.problem;
  for (std::size_t k = 0; k < problem.boxes.size(); ++k) {
    const BoxBlock& box = problem.boxes[k];
    if (box_at_[k] >= 0) right_[box_at_[k]] = box.target - motion_[box.row];
  }
  for (std::size_t k = 0; k < problem.cones.size(); ++k) {
    if (cone_at_[k] < 0) continue;
    const Branch& own = branches_[k];
    if (own.holds) {
      right_[cone_at_[k]] = -motion_[problem.cones[k].row];
      continue;
    }
    const Vector3 du = motion_.segment<3>(problem.cones[k].row) - own.motion;
    right_.segment<3>(cone_at_[k]) = own.right - (own.slips ? own.act(du) : du);
  }
}

void ConeIsland::move_unknowns(const ConePart& part, int count) {
  for (int j = 0; j < count; ++j) {
    x_[unknown_row_[static_cast<std::size_t>(j)]] += row_scale_[j] * right_[j];
  }
  for (std::size_t k = 0; k < part.problem.cones.size(); ++k) {
    const int at = cone_at_[k];
    if (at < 0 || !branches_[k].holds) continue;
    x_.segment<2>(part.problem.cones[k].row + 1) +=
        row_scale_[at] * right_[at] * branches_[k].along();
  }
}

}  // namespace sinew::qp
