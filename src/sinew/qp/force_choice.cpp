#include "sinew/qp/force_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/linalg/index.hpp"
#include "sinew/qp/friction_cone.hpp"

namespace sinew::qp {

namespace {

constexpr double kAddedCompliance = 1e-6;  // a
// Of the coefficient: friction of points that rest stays below its limit by more than the part that
// qp::slides() takes for sliding.
constexpr double kInside = 1.0 - 1e-6;
constexpr int kMaxClosings = 4;  // in which points are found to close
// Gaps that may be closed before anything is known of the motion, relative to rounding.
constexpr double kNearGap = 1e3;
// Of the motion that the largest effort causes at the point: less is no slip.
constexpr double kNoSlip = 1e-11;
// Of the largest effort: less is none.
constexpr double kNoEffort = 1e-12;

using linalg::at;

}  // namespace

const BoxBlock* ForceChoice::box(int block) const {
  return at(block) < problem_->boxes.size() ? &problem_->boxes[at(block)] : nullptr;
}

double ForceChoice::friction(int block) const {
  return problem_->cones[at(block) - problem_->boxes.size()].friction;
}

bool ForceChoice::find(const ConeProblem& problem, const ForceScales& scales) {
  problem_ = &problem;
  scales_ = &scales;
  parts_.find(problem, scales, solver_, rows_);
  if (parts_.parts().empty()) return false;
  role_.assign(problem.boxes.size() + problem.cones.size(), Role::open);
  tried_ = role_;
  x_.resize(at(problem.offset.size()));
  return true;
}

bool ForceChoice::any_moves() const {
  return std::ranges::any_of(parts_.parts(),
                             [](const ForcePart& part) { return !part.rests && !part.large; });
}

bool ForceChoice::any_moves_alone() const {
  return std::ranges::any_of(parts_.parts(),
                             [](const ForcePart& part) { return part.moves_alone(); });
}

double ForceChoice::motion(const Eigen::Ref<const VectorX>& offset, std::span<const double> x,
                           int row) const {
  const Eigen::Map<const VectorX> all(x.data(), std::ssize(x));
  return offset[row] + problem_->matrix.col(row).dot(all);  // W is symmetric
}

// Before anything is known of the motion: what would close without a force, or had one.
ForceChoice::Role ForceChoice::guess(const Eigen::Ref<const VectorX>& offset,
                                     std::span<const double> x, int block) const {
  const int row = rows_of(*problem_, block).row;
  const double near = kNearGap * scales_->rounding / scales_->unit[at(row)], had = x[at(row)];
  const BoxBlock* own = box(block);
  if (own == nullptr) return had > 0.0 || offset[row] <= near ? Role::closed : Role::open;
  const double beyond = offset[row] - own->target;
  const bool up = std::isinf(own->upper), down = std::isinf(own->lower);
  if (up && !down && had <= own->lower && beyond > near) return Role::at_lower;
  if (down && !up && had >= own->upper && beyond < -near) return Role::at_upper;
  return Role::closed;
}

// In a solution.
ForceChoice::Role ForceChoice::role(const Eigen::Ref<const VectorX>& offset,
                                    std::span<const double> x, int block) const {
  const int row = rows_of(*problem_, block).row;
  const double rounding = scales_->rounding / scales_->unit[at(row)];
  const double moved = motion(offset, x, row);
  const BoxBlock* own = box(block);
  if (own == nullptr) return moved <= rounding || x[at(row)] > 0.0 ? Role::closed : Role::open;
  if (std::abs(moved - own->target) <= rounding) return Role::closed;
  if (x[at(row)] <= own->lower) return Role::at_lower;
  return x[at(row)] >= own->upper ? Role::at_upper : Role::closed;
}

void ForceChoice::rest(Eigen::Ref<VectorX> offset, std::span<double> x, bool solved) {
  for (ForcePart& part : parts_.parts()) {
    if (part.rests || part.mixed || (solved && part.large)) continue;
    bool differs = !solved;
    for (const int block : parts_.blocks(part)) {
      Role& own = role_[at(block)];
      own = solved ? role(offset, x, block) : guess(offset, x, block);
      differs = differs || own != tried_[at(block)];
    }
    part.rests = differs && rest(part, offset, x);
  }
}

bool ForceChoice::rest(const ForcePart& part, Eigen::Ref<VectorX> offset, std::span<double> x) {
  for (int round = 0; round < kMaxClosings; ++round) {
    for (const int block : parts_.blocks(part)) tried_[at(block)] = role_[at(block)];
    std::ranges::copy(x, x_.begin());
    gather(part);
    if (rows_.rows.empty() || !find_least(offset)) return false;
    for (std::size_t i = 0; i < rows_.rows.size(); ++i) {
      const int row = rows_.rows[i];
      x_[at(row)] = scales_->unit[at(row)] * effort_.view()(static_cast<Eigen::Index>(i), 0);
    }
    if (close_more(part, offset)) continue;
    if (wedges()) return false;
    for (std::size_t i = 0; i < rows_.rows.size(); ++i) {
      const int row = rows_.rows[i];
      const auto k = static_cast<Eigen::Index>(i);
      offset[row] += (goal_.view()(k, 0) - fitted_.view()(k, 0)) / scales_->unit[at(row)];
    }
    for (const int block : parts_.blocks(part)) {
      const int row = rows_of(*problem_, block).row, count = box(block) != nullptr ? 1 : 3;
      for (int c = row; c < row + count; ++c) x[at(c)] = x_[at(c)];
    }
    return true;
  }
  return false;
}

// Rows of the closed blocks into rows_; the efforts of the others into x_.
void ForceChoice::gather(const ForcePart& part) {
  rows_.clear();
  for (const int block : parts_.blocks(part)) {
    const int row = rows_of(*problem_, block).row;
    const bool closed = role_[at(block)] == Role::closed;
    if (const BoxBlock* own = box(block)) {
      const double unit = scales_->unit[at(row)];
      x_[at(row)] = closed ? 0.0 : role_[at(block)] == Role::at_lower ? own->lower : own->upper;
      if (closed) rows_.add({.lower = own->lower / unit, .upper = own->upper / unit}, row);
      continue;
    }
    for (int c = row; c < row + 3; ++c) x_[at(c)] = 0.0;
    if (!closed) continue;
    const double mu = friction(block);
    if (mu > 0.0) rows_.add({.kind = EffortSet::Kind::cone, .friction = kInside * mu}, row);
    if (mu == 0.0) rows_.add({}, row);
  }
  rows_.gather(*problem_, *scales_);
}

// The least efforts with which the closed rows of rows_ do not move, beside the others in x_.
bool ForceChoice::find_least(Eigen::Ref<VectorX> offset) {
  if (!solver_.factorise(rows_.matrix.view(), rows_.own)) return false;
  const auto count = std::ssize(rows_.rows);
  auto goal = goal_.shape(count, 1).col(0), fitted = fitted_.shape(count, 1).col(0);
  for (const EffortSet& set : rows_.sets) {
    for (int c = 0; c < set.size(); ++c) {
      const int row = rows_.rows[at(set.row + c)];
      goal[set.row + c] = -scales_->unit[at(row)] * motion(offset, x_, row);
    }
  }
  for (const BoxBlock& own : problem_->boxes) {
    const auto it = std::ranges::find(rows_.rows, own.row);
    if (it == rows_.rows.end()) continue;
    goal[it - rows_.rows.begin()] += scales_->unit[at(own.row)] * own.target;
  }
  fitted = goal;
  if (solver_.fit(fitted) > scales_->rounding) return false;
  return solver_.find(rows_.sets, effort_.shape(count, 1).col(0));
}

// Whether open points penetrate; they are then closed.
bool ForceChoice::close_more(const ForcePart& part, const Eigen::Ref<const VectorX>& offset) {
  bool found = false;
  for (const int block : parts_.blocks(part)) {
    if (box(block) != nullptr || role_[at(block)] == Role::closed) continue;
    const int row = rows_of(*problem_, block).row;
    if (motion(offset, x_, row) >= scales_->rounding) continue;
    role_[at(block)] = Role::closed;
    found = true;
  }
  return found;
}

bool ForceChoice::wedges() {
  const auto effort = effort_.view().col(0);
  const double none = kNoEffort * effort.cwiseAbs().maxCoeff();
  const bool limited = std::ranges::any_of(rows_.sets, [&](const EffortSet& set) {
    if (set.kind != EffortSet::Kind::cone || effort[set.row] <= none) return false;
    return slides(effort.segment<3>(set.row), set.friction);
  });
  return limited && solver_.has_self_stress(rows_.sets);
}

Eigen::Map<const MatrixX> ForceChoice::regularised() {
  const auto count = problem_->offset.size();
  auto matrix = matrix_.shape(count, count);
  matrix = problem_->matrix;
  for (const ForcePart& part : parts_.parts()) {
    if (!part.moves_alone()) continue;
    double sum = 0.0;
    const auto each = [&](auto&& visit) {
      for (const int block : parts_.blocks(part)) {
        const BlockRows own = rows_of(*problem_, block);
        for (int c = own.row; c < own.row + own.count; ++c) visit(c, scales_->unit[at(c)]);
      }
    };
    each([&](int row, double unit) { sum += unit * unit * problem_->matrix(row, row); });
    const double added = kAddedCompliance * sum / part.rows;
    each([&](int row, double unit) { matrix(row, row) += added / (unit * unit); });
  }
  return std::as_const(matrix_).view();
}

void ForceChoice::align(Eigen::Ref<VectorX> offset, std::span<const double> x) {
  for (const ForcePart& part : parts_.parts()) {
    if (!part.moves_alone()) continue;
    rows_.clear();
    for (const int block : parts_.blocks(part)) {
      if (role(offset, x, block) != Role::closed) continue;
      const int row = rows_of(*problem_, block).row;
      rows_.add({}, row);
    }
    if (rows_.rows.empty()) continue;
    rows_.gather(*problem_, *scales_);
    if (!solver_.factorise(rows_.matrix.view(), rows_.own)) continue;
    const auto count = std::ssize(rows_.rows);
    auto goal = goal_.shape(count, 1).col(0), fitted = fitted_.shape(count, 1).col(0);
    for (Eigen::Index k = 0; k < count; ++k) {
      const int row = rows_.rows[at(k)];
      goal[k] = scales_->unit[at(row)] * offset[row];
    }
    for (const BoxBlock& own : problem_->boxes) {
      const auto it = std::ranges::find(rows_.rows, own.row);
      if (it == rows_.rows.end()) continue;
      goal[it - rows_.rows.begin()] -= scales_->unit[at(own.row)] * own.target;
    }
    fitted = goal;
    if (solver_.fit(fitted) > scales_->rounding) continue;
    for (Eigen::Index k = 0; k < count; ++k) {
      const int row = rows_.rows[at(k)];
      offset[row] += (fitted[k] - goal[k]) / scales_->unit[at(row)];
    }
  }
}

// The efforts that a block may have at the motion of a solution.
EffortSet ForceChoice::set_of(const Eigen::Ref<const VectorX>& offset, std::span<const double> x,
                              int block, double largest) const {
  const int row = rows_of(*problem_, block).row;
  const double unit = scales_->unit[at(row)];
  if (const BoxBlock* own = box(block))
    return {.lower = own->lower / unit, .upper = own->upper / unit};
  const double mu = friction(block);
  if (mu == 0.0) return {};
  const Eigen::Vector2d slip(motion(offset, x, row + 1), motion(offset, x, row + 2));
  const double w = problem_->matrix.diagonal().segment<3>(row).sum() / 3.0;
  if (slip.norm() <= kNoSlip * w * largest) return {.kind = EffortSet::Kind::cone, .friction = mu};
  const Eigen::Vector2d friction(x[at(row + 1)], x[at(row + 2)]);
  const bool loaded = x[at(row)] > kNoEffort * largest && friction.norm() > 0.0;
  const Eigen::Vector2d along =
      loaded ? friction.normalized() : Eigen::Vector2d(-slip.normalized());
  return {.kind = EffortSet::Kind::ray, .along = mu * along};
}

void ForceChoice::lessen(const Eigen::Ref<const VectorX>& offset, std::span<double> x) {
  for (const ForcePart& part : parts_.parts()) {
    if (part.rests || part.large) continue;
    double largest = 0.0;
    for (const int block : parts_.blocks(part)) {
      const int row = rows_of(*problem_, block).row;
      largest = std::max(largest, std::abs(x[at(row)]) / scales_->unit[at(row)]);
    }
    rows_.clear();
    for (const int block : parts_.blocks(part)) {
      if (role(offset, x, block) != Role::closed) continue;
      rows_.add(set_of(offset, x, block, largest), rows_of(*problem_, block).row);
    }
    if (rows_.rows.empty()) continue;
    rows_.gather(*problem_, *scales_);
    const auto count = std::ssize(rows_.rows);
    if (!solver_.factorise(rows_.matrix.view(), rows_.own) || solver_.rank() == count) continue;
    auto effort = effort_.shape(count, 1).col(0), fitted = fitted_.shape(count, 1).col(0);
    for (Eigen::Index k = 0; k < count; ++k) {
      const int row = rows_.rows[at(k)];
      effort[k] = x[at(row)] / scales_->unit[at(row)];
    }
    auto before = goal_.shape(count, 1).col(0);
    before.setZero();
    for (Eigen::Index k = 0; k < count; ++k) before += effort[k] * rows_.matrix.view().col(k);
    fitted = before;
    solver_.fit(fitted);
    if (!solver_.find(rows_.sets, effort)) continue;
    // What was left out of W as rounding may be the motion of a body that is nearly held.
    for (Eigen::Index k = 0; k < count; ++k) before -= effort[k] * rows_.matrix.view().col(k);
    if (before.cwiseAbs().maxCoeff() > scales_->rounding) continue;
    for (Eigen::Index k = 0; k < count; ++k) {
      const int row = rows_.rows[at(k)];
      x[at(row)] = scales_->unit[at(row)] * effort[k];
    }
  }
}

}  // namespace sinew::qp
