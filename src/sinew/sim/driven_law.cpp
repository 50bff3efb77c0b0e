#include "sinew/sim/driven_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/linalg/dense.hpp"

namespace sinew::sim {

namespace {

constexpr int kMostDrivenRounds = 60;
// Of the effort and of what the robot's compliance allows.
constexpr double kDrivenTolerance = 1e-13;
// Each row that is taken out leaves a rounding of the others' own compliance behind.
constexpr double kRounding = 16.0 * std::numeric_limits<double>::epsilon();

}  // namespace

bool DrivenLaw::takes(const ActuatorRange& range) {
  if (range.drive != nullptr) return true;
  return !range.owned && range.kind == CommandKind::motion && std::isinf(range.effort_min) &&
         std::isinf(range.effort_max);
}

bool DrivenLaw::stabilised(const LawProblem& problem, int negative_pivots) {
  std::vector<const ActuatorRange*> taken;
  for (const ActuatorRange& range : problem.actuators) {
    if (takes(range)) taken.push_back(&range);
  }
  const auto count = static_cast<Eigen::Index>(taken.size());
  if (count < negative_pivots) return false;
  MatrixX own(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const ActuatorRange& range = *taken[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < count; ++j) {
      own(i, j) = problem.compliance(range.row, taken[static_cast<std::size_t>(j)]->row);
    }
    if (range.drive == nullptr) continue;
    const auto at = range.drive->respond(range.drive_step, problem.delta[range.row]);
    if (!(at.slope < 0.0)) return false;  // a flat curve holds nothing
    own(i, i) -= 1.0 / at.slope;
  }
  const VectorX values = linalg::symmetric_eigenvalues(own);
  return (values.array() < 0.0).count() == negative_pivots;
}

DrivenLaw::DrivenLaw(int rows, int ranges)
    : compliance_(rows, rows), coupling_(rows, ranges), delta_free_(rows) {
  driven_.reserve(static_cast<std::size_t>(ranges));
  ranges_.reserve(static_cast<std::size_t>(ranges));
}

void DrivenLaw::linearise(const LawProblem& problem) {
  for (Row& row : driven_) {
    if (row.held) continue;
    const ActuatorRange& range = problem.actuators[static_cast<std::size_t>(row.actuator)];
    row.at = range.drive->respond(range.drive_step, row.motion);
  }
}

void DrivenLaw::eliminate() {
  for (std::size_t k = 0; k < driven_.size(); ++k) {
    Row& row = driven_[k];
    const int d = row.row;
    if (row.held) {
      row.gain = -1.0 / compliance_(d, d);
      row.offset = row.gain * (delta_free_[d] - row.motion);
    } else {
      const double softer = 1.0 - row.at.slope * compliance_(d, d);
      row.gain = row.at.slope / softer;
      row.offset = (row.at.effort + row.at.slope * (delta_free_[d] - row.motion)) / softer;
    }
    auto own = coupling_.col(static_cast<Eigen::Index>(k));
    own = compliance_.col(d);
    delta_free_ += row.offset * own;
    compliance_.noalias() += row.gain * own * own.transpose();
    // Until it is put back, the row takes no effort and moves nothing.
    compliance_.col(d).setZero();
    compliance_.row(d).setZero();
  }
}

// Where held rows leave nothing to move, what is left of W is rounding, of either sign.
void DrivenLaw::round_off(const LawProblem& problem) {
  const double share = kRounding * static_cast<double>(driven_.size());
  for (Eigen::Index i = 0; i < compliance_.rows(); ++i) {
    if (std::abs(compliance_(i, i)) > share * std::abs(problem.compliance(i, i))) continue;
    compliance_.col(i).setZero();
    compliance_.row(i).setZero();
  }
}

// Efforts and motions of the driven rows, the last one eliminated first; the farthest that a curve
// was left, relative.
double DrivenLaw::close(const LawProblem& problem, std::span<double> effort) {
  double worst = 0.0;
  for (std::size_t k = driven_.size(); k-- > 0;) {
    Row& row = driven_[k];
    const auto own = coupling_.col(static_cast<Eigen::Index>(k));
    double reach = 0.0;
    for (Eigen::Index j = 0; j < own.size(); ++j) {
      // Rows taken out before this one are not yet known, and had left its coupling.
      if (j != row.row) reach += own[j] * effort[static_cast<std::size_t>(j)];
    }
    effort[static_cast<std::size_t>(row.row)] = row.offset + row.gain * reach;
  }
  for (Row& row : driven_) {
    if (row.held) continue;
    double motion = problem.delta_free[row.row];
    for (Eigen::Index j = 0; j < compliance_.cols(); ++j) {
      motion += problem.compliance(row.row, j) * effort[static_cast<std::size_t>(j)];
    }
    const ActuatorRange& range = problem.actuators[static_cast<std::size_t>(row.actuator)];
    const auto there = range.drive->respond(range.drive_step, motion);
    const double lambda = effort[static_cast<std::size_t>(row.row)];
    const double scale = std::max(std::abs(lambda), std::abs(there.effort)) +
                         std::abs(there.slope * motion) + 1e-300;
    worst = std::max(worst, std::abs(lambda - there.effort) / scale);
    row.motion = motion;
  }
  return worst;
}

LawStatus DrivenLaw::solve(const LawProblem& problem, std::span<double> effort) {
  driven_.clear();
  before_.assign(effort.begin(), effort.end());  // a law may look back at the last step
  ranges_.assign(problem.actuators.begin(), problem.actuators.end());
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    ActuatorRange& range = ranges_[i];
    if (!takes(range) || !(problem.compliance(range.row, range.row) != 0.0)) continue;
    const bool held = range.drive == nullptr;
    const double motion = held ? range.value : problem.delta[range.row];
    driven_.push_back({static_cast<int>(i), range.row, held, motion, {}, 0.0, 0.0});
    range.kind = CommandKind::effort;
    range.value = range.effort_min = range.effort_max = 0.0;
    range.motion_min = -INFINITY;
    range.motion_max = INFINITY;
  }
  LawStatus status = LawStatus::solved;
  for (int round = 0; round < kMostDrivenRounds; ++round) {
    linearise(problem);
    compliance_ = problem.compliance;
    delta_free_ = problem.delta_free;
    eliminate();
    round_off(problem);
    std::ranges::copy(before_, effort.begin());
    for (const Row& row : driven_) effort[static_cast<std::size_t>(row.row)] = 0.0;
    const LawProblem rest = problem.reduced(ranges_, compliance_, delta_free_);
    status = law_->solve(rest, effort);
    if (status == LawStatus::failed) return status;
    if (close(problem, effort) <= kDrivenTolerance) return status;
  }
  return status;
}

double DrivenLaw::violation(const LawProblem& problem, std::span<const double> effort) const {
  double worst = law_->violation(problem, effort);
  for (std::size_t i = 0; i < problem.actuators.size(); ++i) {
    const ActuatorRange& range = problem.actuators[i];
    if (range.drive == nullptr) continue;
    const auto at = range.drive->respond(range.drive_step, problem.delta[range.row]);
    const double off = effort[static_cast<std::size_t>(range.row)] - at.effort;
    // In motion: along the curve, or along the robot's own compliance where the curve is flat.
    const double steepness = std::max(-at.slope, 1.0 / problem.compliance(range.row, range.row));
    worst = std::max(worst, range.motion_scale * std::abs(off) / steepness);
  }
  return worst;
}

}  // namespace sinew::sim
