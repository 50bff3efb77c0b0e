#include "sinew/qp/least_forces.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/linalg/index.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::qp {

namespace {

// Large problems get fewer steps: where the law would be solved faster, a search that takes long
// does not pay.
constexpr double kWorth = 4e6;  // steps times rows times rank squared
constexpr int kMostDualSteps = 60, kFewDualSteps = 12, kMaxDualHalvings = 30;
// Of |c|: the gradient of the solution, and the largest that rounding may leave.
constexpr double kDualSolved = 1e-14, kDualUsable = 1e-12;
// Efforts larger than those without sets by this factor are none.
constexpr double kFarEfforts = 100.0;
// Of the diagonal: a W that is more negative is indefinite.
constexpr double kIndefinite = 1e-8;
// Of the unit efforts: a smaller self-stress is rounding.
constexpr double kNoStress = 1e-6;
// Of the largest diagonal: what is added to it, in proportion to |gradient|/|c| (Levenberg and
// Marquardt), since few efforts inside their sets leave the matrix singular. Where no forces cause
// the motion, a small term lets y grow fast.
constexpr double kShift = 1e-6, kLeastShift = 1e-14, kMoreShift = 100.0, kMostShift = 1e-3;
constexpr double kSufficientGain = 1e-4;  // decrease, of that along the tangent

using linalg::at;

Vector3 project_on_ray(const Vector3& r, const Eigen::Vector2d& along) {
  const Vector3 direction(1.0, along[0], along[1]);
  return std::max(0.0, direction.dot(r)) / direction.squaredNorm() * direction;
}

Vector3 nearest_effort(const Vector3& r, const EffortSet& set) {
  return set.kind == EffortSet::Kind::cone ? project_on_cone(r, set.friction)
                                           : project_on_ray(r, set.along);
}

// Derivative of the projection. On the surface of a cone, with e = r_t/|r_t| and the projection
// s (1, mu e): it is q q^T/q.q + (mu s/|r_t|) p p^T, q = (1, mu e), p tangential and normal to e.
Matrix3 slope_of_nearest(const Vector3& r, const EffortSet& set) {
  const double mu = set.friction, across = r.tail<2>().norm();
  Vector3 direction(1.0, set.along[0], set.along[1]);
  double turn = 0.0;
  if (set.kind == EffortSet::Kind::cone) {
    if (r[0] >= 0.0 && across <= mu * r[0]) return Matrix3::Identity();
    if (r[0] + mu * across <= 0.0) return Matrix3::Zero();
    direction.tail<2>() = mu / across * r.tail<2>();
    turn = mu * (r[0] + mu * across) / ((1.0 + mu * mu) * across);
  } else if (direction.dot(r) <= 0.0) {
    return Matrix3::Zero();
  }
  Matrix3 result = direction * direction.transpose() / direction.squaredNorm();
  if (turn > 0.0) {
    const Eigen::Vector2d p(-r[2] / across, r[1] / across);
    result.bottomRightCorner<2, 2>() += turn * p * p.transpose();
  }
  return result;
}

}  // namespace

bool LeastForces::factorise(const Eigen::Ref<const MatrixX>& matrix, std::span<const double> own) {
  rows_ = matrix.rows();
  unit_ = matrix.diagonal().sum() / static_cast<double>(rows_);
  if (!(unit_ > 0.0)) return false;
  auto columns = columns_.shape(rows_, rows_);
  linalg::grow(left_, at(rows_));
  taken_.assign(at(rows_), 0);
  pivots_.clear();
  for (Eigen::Index i = 0; i < rows_; ++i) left_[at(i)] = matrix(i, i);
  for (rank_ = 0; rank_ < rows_; ++rank_) {
    double most = kDependent;
    int pivot = -1;
    for (std::size_t i = 0; i < at(rows_); ++i) {
      if (taken_[i] != 0) continue;
      if (left_[i] < -kIndefinite * own[i]) return false;
      if (left_[i] <= most * own[i]) continue;
      most = left_[i] / own[i];
      pivot = static_cast<int>(i);
    }
    if (pivot < 0) break;
    auto column = columns.col(rank_);
    column = matrix.col(pivot);
    for (Eigen::Index k = 0; k < rank_; ++k) column -= columns(pivot, k) * columns.col(k);
    const double root = std::sqrt(left_[at(pivot)]);
    column /= root;
    column[pivot] = root;
    taken_[at(pivot)] = 1;
    pivots_.push_back(pivot);
    for (std::size_t i = 0; i < at(rows_); ++i) {
      double& entry = column[static_cast<Eigen::Index>(i)];
      if (taken_[i] != 0 && static_cast<int>(i) != pivot) entry = 0.0;
      left_[i] -= entry * entry;
    }
  }
  columns_.shape(rows_, rank_) /= std::sqrt(unit_);
  return true;
}

double LeastForces::fit(Eigen::Ref<VectorX> motion) {
  const auto columns = columns_.view();
  auto goal = goal_.shape(rank_, 1).col(0);
  const double root = std::sqrt(unit_);
  for (Eigen::Index k = 0; k < rank_; ++k) {
    const int row = pivots_[at(k)];
    double rest = motion[row] / root;
    for (Eigen::Index j = 0; j < k; ++j) rest -= columns(row, j) * goal[j];
    goal[k] = rest / columns(row, k);
  }
  double most = 0.0;
  for (Eigen::Index i = 0; i < rows_; ++i) {
    double fitted = 0.0;
    for (Eigen::Index k = 0; k < rank_; ++k) fitted += columns(i, k) * goal[k];
    most = std::max(most, std::abs(root * fitted - motion[i]));
    motion[i] = root * fitted;
  }
  goal /= root;  // B c = u with B of the unscaled W, see factorise()
  return most;
}

// The efforts of least norm without limits: y = (B^T B)^-1 c.
void LeastForces::start() {
  const auto columns = columns_.view();
  factor_.reshape(static_cast<int>(rank_), 0);
  auto matrix = factor_.leading();
  for (Eigen::Index j = 0; j < rank_; ++j) {
    for (Eigen::Index i = j; i < rank_; ++i) matrix(i, j) = columns.col(i).dot(columns.col(j));
  }
  auto dual = dual_.shape(rank_, 1).col(0);
  dual = goal_.view().col(0);
  if (factor_.factorise()) {
    factor_.solve(dual);
  } else {
    dual.setZero();
  }
}

// P_K(B y + shift) into effort_. @return |aim|^2/2 - |aim - P_K(aim)|^2/2.
double LeastForces::project(std::span<const EffortSet> sets) {
  const auto aim = aim_.view().col(0);
  auto effort = effort_.shape(rows_, 1).col(0);
  double missed = 0.0;
  for (const EffortSet& set : sets) {
    if (set.kind == EffortSet::Kind::interval) {
      effort[set.row] = std::clamp(aim[set.row], set.lower, set.upper);
      const double miss = aim[set.row] - effort[set.row];
      missed += (aim[set.row] - miss) * (aim[set.row] + miss);
      continue;
    }
    const Vector3 own = aim.segment<3>(set.row);
    const Vector3 nearest = nearest_effort(own, set);
    effort.segment<3>(set.row) = nearest;
    missed += nearest.squaredNorm();
  }
  return 0.5 * missed;
}

// phi at trial_, with gradient_, aim_ and effort_ there.
double LeastForces::evaluate(std::span<const EffortSet> sets) {
  const auto columns = columns_.view();
  const auto y = trial_.view().col(0);
  auto aim = aim_.shape(rows_, 1).col(0);
  auto gradient = gradient_.shape(rank_, 1).col(0);
  aim = shift_.view().col(0);
  for (Eigen::Index k = 0; k < rank_; ++k) aim += y[k] * columns.col(k);
  const double value = project(sets);
  const auto effort = effort_.view().col(0);
  const auto goal = goal_.view().col(0);
  for (Eigen::Index k = 0; k < rank_; ++k) gradient[k] = columns.col(k).dot(effort) - goal[k];
  return value - goal.dot(y);
}

// The Newton step at the last point that was evaluated. @param shift of the diagonal.
bool LeastForces::form_step(std::span<const EffortSet> sets, double shift) {
  const auto columns = columns_.view();
  const auto aim = aim_.view().col(0);
  auto slopes = slopes_.shape(rows_, rank_);
  for (const EffortSet& set : sets) {
    if (set.kind == EffortSet::Kind::interval) {
      const bool inside = aim[set.row] > set.lower && aim[set.row] < set.upper;
      for (Eigen::Index k = 0; k < rank_; ++k) {
        slopes(set.row, k) = inside ? columns(set.row, k) : 0.0;
      }
      continue;
    }
    const Matrix3 own = slope_of_nearest(aim.segment<3>(set.row), set);
    for (Eigen::Index k = 0; k < rank_; ++k) {
      slopes.col(k).segment<3>(set.row) = own * columns.col(k).segment<3>(set.row);
    }
  }
  factor_.reshape(static_cast<int>(rank_), 0);
  auto matrix = factor_.leading();
  double largest = 0.0;
  for (Eigen::Index j = 0; j < rank_; ++j) {
    for (Eigen::Index i = j; i < rank_; ++i) matrix(i, j) = columns.col(i).dot(slopes.col(j));
    largest = std::max(largest, matrix(j, j));
  }
  for (Eigen::Index j = 0; j < rank_; ++j) matrix(j, j) += shift * std::max(largest, 1e-3);
  auto step = step_.shape(rank_, 1).col(0);
  step = -gradient_.view().col(0);
  if (!factor_.factorise()) return false;
  factor_.solve(step);
  return step.allFinite();
}

// Any z in K with B^T z = c has c.y = z.B y <= z.P_K(B y), hence |z| >= c.y/|P_K(B y)|.
bool LeastForces::needs_more(double size) const {
  const double work = goal_.view().col(0).dot(trial_.view().col(0));
  return work > size * effort_.view().norm();
}

bool LeastForces::newton(std::span<const EffortSet> sets) {
  const double size = goal_.view().norm() + shift_.view().norm();
  trial_.shape(rank_, 1) = dual_.view();
  double value = evaluate(sets);
  const double most = kFarEfforts * (aim_.view().norm() + shift_.view().norm());
  double miss = gradient_.view().norm();
  const auto rank = static_cast<double>(rank_);
  const double affordable = kWorth / (static_cast<double>(rows_) * rank * rank);
  const int steps =
      static_cast<int>(std::clamp(affordable, double{kFewDualSteps}, double{kMostDualSteps}));
  for (steps_ = 0; miss > kDualSolved * size && steps_ < steps; ++steps_) {
    if (needs_more(most)) return false;
    double shift = std::clamp(kShift * miss / size, kLeastShift, kShift);
    while (shift < kMostShift && !form_step(sets, shift)) shift *= kMoreShift;
    if (!(shift < kMostShift)) break;
    const double along = step_.view().col(0).dot(gradient_.view().col(0));
    double share = 1.0;
    const double before = miss;
    bool gains = false;
    for (int halving = 0; halving < kMaxDualHalvings && !gains; ++halving, share *= 0.5) {
      trial_.view() = dual_.view() + share * step_.view();
      const double next = evaluate(sets), left = gradient_.view().norm();
      // Near the solution the difference of two values is rounding.
      gains = next <= value + kSufficientGain * share * along || left <= 0.5 * miss;
      if (!gains) continue;
      value = next;
      miss = left;
    }
    if (!gains) break;
    dual_.view() = trial_.view();
    if (miss <= kDualUsable * size && miss > 0.5 * before) break;  // rounding
  }
  trial_.view() = dual_.view();
  evaluate(sets);
  return miss <= kDualUsable * size;
}

bool LeastForces::find(std::span<const EffortSet> sets, Eigen::Ref<VectorX> effort) {
  shift_.shape(rows_, 1).setZero();
  start();
  if (!newton(sets)) return false;
  effort = effort_.view().col(0);
  return true;
}

// The projection of unit efforts x, inside the cones, onto the cone C of self-stresses,
//   min |z - x|^2/2   s.t.   B^T z = 0,   z in K,
// is zero only if C contains nothing else: x.z > 0 for all other z of K (Moreau 1962).
bool LeastForces::has_self_stress(std::span<const EffortSet> sets) {
  auto shift = shift_.shape(rows_, 1).col(0);
  std::vector<EffortSet>& open = open_;
  open.assign(sets.begin(), sets.end());
  shift.setZero();
  for (EffortSet& set : open) {
    if (set.kind != EffortSet::Kind::interval) {
      shift[set.row] = 1.0;
      continue;
    }
    const bool up = std::isinf(set.upper), down = std::isinf(set.lower);
    set.lower = down ? set.lower : 0.0;
    set.upper = up ? set.upper : 0.0;
    if (up != down) shift[set.row] = up ? 1.0 : -1.0;
  }
  goal_.shape(rank_, 1).setZero();
  dual_.shape(rank_, 1).setZero();
  newton(open);
  return effort_.view().norm() > kNoStress * shift.norm();
}

}  // namespace sinew::qp
