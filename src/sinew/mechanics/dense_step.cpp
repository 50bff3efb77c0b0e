#include "sinew/mechanics/dense_step.hpp"

#include <algorithm>

namespace sinew::mechanics {

DenseStep::DenseStep(Eigen::Index coordinates, const OwnRows& own, RowMemory& memory)
    : own_(own),
      memory_(memory),
      decomposed_(coordinates),
      symmetric_factor_(coordinates),
      pivots_(coordinates),
      spectrum_(coordinates) {
  const Eigen::Index n = coordinates;
  const auto rows = static_cast<Eigen::Index>(own.rows.size());
  for (VectorX* v : {&right_, &motion_, &scratch_, &lessening_}) v->setZero(n);
  for (MatrixX* m : {&matrix_, &symmetric_}) m->setZero(n, n);
  for (MatrixX* m : {&jacobian_, &second_jacobian_, &pulled_}) m->setZero(3, n);
  rows_.setZero(n, rows);
  moved_rows_.setZero(n, rows);
  soft_rows_.setZero(n, rows);
  free_motion_.setZero(rows);
}

void DenseStep::linearise(const LinearisationRequest& request) {
  definite_wanted_ = request.tangent == Tangent::rotated;
  iterating_ = request.iterating;
  force_scale_ = form(request, right_, matrix_);
  if (lessens_) right_ -= lessening_;
  add_row_stiffness(matrix_);
}

void DenseStep::add_curvature(const RowCurvature& curvature) {
  site_jacobian(curvature.first.number, jacobian_);
  site_jacobian(curvature.second.number, second_jacobian_);
  pulled_.noalias() = curvature.curvature * second_jacobian_;
  symmetric_.noalias() = jacobian_.transpose() * pulled_;
  matrix_ -= symmetric_;
  if (curvature.first.number != curvature.second.number) matrix_ -= symmetric_.transpose();
}

void DenseStep::take_rows(const RowValues& rows) {
  rows_.setZero();
  for (std::size_t e = 0; e < own_.entries.size(); ++e) {
    const auto& entry = own_.entries[e];
    const Vector3& direction = rows.direction[static_cast<std::size_t>(entry.entry)];
    memory_.directions[e] = direction;
    site_jacobian(entry.site, jacobian_);
    for (Eigen::Index i = 0; i < rows_.rows(); ++i) {
      rows_(i, entry.row) += direction.dot(jacobian_.col(i));
    }
  }
}

void DenseStep::retake_rows(const RowValues& rows) {
  take_rows(rows);
  respond();
}

void DenseStep::find_imbalance(std::span<const double> effort) {
  for (std::size_t k = 0; k < own_.rows.size(); ++k) {
    memory_.effort[static_cast<Eigen::Index>(k)] = effort[static_cast<std::size_t>(own_.rows[k])];
  }
  scratch_ = right_;
  scratch_.noalias() += rows_ * memory_.effort;
}

double DenseStep::residual(std::span<const double> effort, std::span<double> imbalance) {
  find_imbalance(effort);
  if (!imbalance.empty()) std::copy_n(scratch_.data(), scratch_.size(), imbalance.data());
  return scratch_.norm();
}

void DenseStep::lessen(std::span<const double> force) {
  lessens_ = !force.empty();
  if (lessens_) lessening_ = Eigen::Map<const VectorX>(force.data(), right_.size());
}

Inertia DenseStep::condense() {
  if (motion_.size() == 0) return {};  // it does not move
  symmetric_ = 0.5 * (matrix_ + matrix_.transpose());
  pivots_.compute(symmetric_);
  Inertia inertia;
  inertia.negative_pivots = pivots_.negative();
  if (inertia.negative_pivots > 0 && definite_wanted_) {
    make_definite();
    symmetric_ = 0.5 * (matrix_ + matrix_.transpose());
    inertia.negative_pivots = 0;
  }
  decomposed_.compute(matrix_);
  is_symmetric_ = symmetric_ == matrix_;
  if (!is_symmetric_ && rows_.cols() > 0) symmetric_factor_.compute(symmetric_);
  respond();
  if (inertia.negative_pivots > 0) inertia.status = linalg::FactorStatus::indefinite;
  if (!moved_rows_.allFinite() || pivots_.vanishes()) {
    inertia.status = linalg::FactorStatus::singular;
  }
  return inertia;
}

void DenseStep::respond() {
  decomposed_.solve(rows_, moved_rows_);
  if (rows_.cols() == 0) return;
  decomposed_.solve(right_, motion_);
  free_motion_.noalias() = rows_.transpose() * motion_;
  if (is_symmetric_) {
    soft_rows_ = moved_rows_;
  } else {
    symmetric_factor_.solve(rows_, soft_rows_);
  }
}

// In the directions in which the body would buckle the rotated tangent is as stiff as the exact one
// is soft there: a law's program must be convex, and a step must go downhill.
void DenseStep::make_definite() {
  spectrum_.compute(symmetric_);
  const double floor = softest();
  for (Eigen::Index i = 0; i < motion_.size(); ++i) {
    const double value = spectrum_.values()[i];
    if (value >= floor) break;  // ascending
    const auto direction = spectrum_.vectors().col(i);
    matrix_.noalias() += (std::max(-value, floor) - value) * direction * direction.transpose();
  }
}

// The law's programs want a symmetric W. They get that of A_s, the symmetric part of A; the free
// motion takes the rest, H (A^-1 - A_s^-1) H^T lambda, at the efforts known last, so that in the
// limit of Newton's iterations the law holds of the motion. With A = A_s + A_a, A_s > 0, the
// iteration lambda <- lambda - W_s^-1 (W lambda - d) contracts: in the metric of A_s, W is the
// compression of (I + S)^-1 with S skew, whose numerical range lies in |z - 1/2| <= 1/2. The
// symmetric part of W itself is no such bound: it is softer than W_s by S^2, and near the rank of
// redundant joints the iteration then diverges.
void DenseStep::add_compliance(std::span<const int> place, MatrixX& compliance,
                               VectorX& free_motion) const {
  const auto& rows = own_.rows;
  const auto place_of = [&](Eigen::Index own) {
    return place[static_cast<std::size_t>(rows[static_cast<std::size_t>(own)])];
  };
  for (Eigen::Index j = 0; j < rows_.cols(); ++j) {
    const int across = place_of(j);
    if (across < 0) continue;
    for (Eigen::Index i = 0; i <= j; ++i) {
      const int down = place_of(i);
      if (down < 0) continue;
      const double soft = rows_.col(i).dot(soft_rows_.col(j));
      compliance(down, across) += soft;
      if (i != j) compliance(across, down) += soft;
      if (!iterating_) continue;
      free_motion[down] += (rows_.col(i).dot(moved_rows_.col(j)) - soft) * memory_.effort[j];
      if (i == j) continue;
      free_motion[across] += (rows_.col(j).dot(moved_rows_.col(i)) - soft) * memory_.effort[i];
    }
    free_motion[across] += free_motion_[j];
  }
}

void DenseStep::solve_motion(std::span<const double> effort) {
  find_imbalance(effort);
  decomposed_.solve(scratch_, motion_);
  depart();
}

Vector3 DenseStep::proposed_motion(int site) const {
  if (motion_.size() == 0) return Vector3::Zero();
  site_jacobian(site, jacobian_);
  return jacobian_ * motion_;
}

void DenseStep::solve(std::span<const double> right, std::span<double> result) {
  scratch_ = Eigen::Map<const VectorX>(right.data(), motion_.size());
  decomposed_.solve(scratch_, Eigen::Map<VectorX>(result.data(), motion_.size()));
}

void DenseStep::propose_motion(std::span<const double> motion) {
  std::ranges::copy(motion, motion_.data());
  depart();
}

void DenseStep::propose_drift(double time_step) {
  drift(time_step, motion_);
  depart();
}

std::size_t DenseStep::bytes() const {
  const Eigen::Index n = right_.size();
  const Eigen::Index numbers = 3 * n * n + 2 * rows_.size() + 9 * n;
  return sizeof(double) * static_cast<std::size_t>(numbers);
}

}  // namespace sinew::mechanics
