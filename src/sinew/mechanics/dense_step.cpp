#include "sinew/mechanics/dense_step.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/core/error.hpp"

namespace sinew::mechanics {

namespace {

// Relative to the sum of the terms of an entry of a row: a few roundings.
constexpr double kRowRounding = 16.0 * kEpsilon;

}  // namespace

DenseStep::DenseStep(Eigen::Index coordinates, const OwnRows& own, RowMemory& memory)
    : own_(own),
      memory_(memory),
      decomposed_(coordinates),
      symmetric_factor_(coordinates),
      pivots_(coordinates),
      spectrum_(coordinates) {
  const Eigen::Index n = coordinates;
  for (VectorX* v : {&right_, &motion_, &scratch_, &subtracted_, &gross_}) v->setZero(n);
  for (MatrixX* m : {&matrix_, &symmetric_}) m->setZero(n, n);
  for (MatrixX* m : {&jacobian_, &second_jacobian_, &pulled_}) m->setZero(3, n);
  for (MatrixX* m : {&rows_, &moved_rows_, &soft_rows_}) m->resize(n, 0);
  make_room(static_cast<Eigen::Index>(own.rows.size()));
  rows_.setZero();
  moved_rows_.setZero();
}

void DenseStep::make_room(Eigen::Index columns) {
  columns_ = columns;
  if (columns <= effort_.size()) return;
  for (MatrixX* m : {&rows_, &moved_rows_, &soft_rows_}) m->resize(right_.size(), columns);
  for (VectorX* v : {&free_motion_, &effort_}) v->resize(columns);
  problem_rows_.reserve(static_cast<std::size_t>(columns));
}

void DenseStep::linearise(const LinearisationRequest& request) {
  definite_wanted_ = request.tangent == Tangent::corotated;
  iterating_ = request.iterating;
  projected_ = request.tangent == Tangent::projected;
  force_scale_ = form(request, right_, matrix_);
  if (subtracts_) right_ -= subtracted_;
  add_row_stiffness(matrix_);
}

void DenseStep::add_geometric_stiffness(const StiffnessPair& pair) {
  site_jacobian(pair.first.number, jacobian_);
  site_jacobian(pair.second.number, second_jacobian_);
  pulled_.noalias() = pair.hessian * second_jacobian_;
  symmetric_.noalias() = jacobian_.transpose() * pulled_;
  matrix_ -= symmetric_;
  if (pair.first.number != pair.second.number) matrix_ -= symmetric_.transpose();
}

void DenseStep::patch_jacobian(const Patch&, MatrixX&) const {
  throw Error(ErrorKind::internal, {}, "a body without a surface is asked how that moves");
}

// Rows that were active before keep their efforts.
void DenseStep::take_surface_rows(const RowValues& rows) {
  surface_rows_before_.swap(surface_rows_);
  surface_rows_.clear();
  auto before = surface_rows_before_.begin();
  for (const OwnRows::SurfaceEntry& entry : own_.surface) {
    if (rows.active[static_cast<std::size_t>(entry.row)] == 0) continue;
    const auto at = static_cast<std::size_t>(entry.entry);
    while (before != surface_rows_before_.end() && before->row < entry.row) ++before;
    const bool known = before != surface_rows_before_.end() && before->row == entry.row;
    surface_rows_.push_back(
        {entry.row, rows.direction[at], rows.patch[at], known ? before->effort : 0.0});
  }
}

// The forces of a cable along one rigid body cancel. Their rounding errors are set to zero, since
// they would look like a compliance, by which laws scale the effort of the row.
void DenseStep::take_lasting_rows(const RowValues& rows) {
  const std::size_t count = own_.entries.size();
  rows_.leftCols(static_cast<Eigen::Index>(own_.rows.size())).setZero();
  for (std::size_t e = 0; e < count; ++e) {
    const auto& entry = own_.entries[e];
    const Vector3& direction = rows.direction[static_cast<std::size_t>(entry.entry)];
    memory_.directions[e] = direction;
    const std::int32_t row = own_.rows[static_cast<std::size_t>(entry.row)];
    if (rows.active[static_cast<std::size_t>(row)] == 0) continue;  // left out of the step
    site_jacobian(entry.site, jacobian_);
    if (e == 0 || own_.entries[e - 1].row != entry.row) gross_.setZero();
    const double size = direction.norm();
    for (Eigen::Index i = 0; i < rows_.rows(); ++i) {
      rows_(i, entry.row) += direction.dot(jacobian_.col(i));
      gross_[i] += size * jacobian_.col(i).norm();
    }
    if (e + 1 < count && own_.entries[e + 1].row == entry.row) continue;
    for (Eigen::Index i = 0; i < rows_.rows(); ++i) {
      if (std::abs(rows_(i, entry.row)) <= kRowRounding * gross_[i]) rows_(i, entry.row) = 0.0;
    }
  }
}

void DenseStep::take_rows(const RowValues& rows) {
  take_surface_rows(rows);
  const auto lasting = static_cast<Eigen::Index>(own_.rows.size());
  make_room(lasting + static_cast<Eigen::Index>(surface_rows_.size()));
  take_lasting_rows(rows);
  for (std::size_t k = 0; k < surface_rows_.size(); ++k) {
    patch_jacobian(surface_rows_[k].patch, jacobian_);
    rows_.col(lasting + static_cast<Eigen::Index>(k)).noalias() =
        jacobian_.transpose() * surface_rows_[k].direction;
  }
  take_shares(rows.groups);
}

void DenseStep::take_shares(const RowGroups& groups) {
  shares_.clear();
  if (groups.empty()) return;
  for (Eigen::Index j = 0; j < columns_; ++j) shares_.push_back(groups.share_of(world_row(j)));
}

std::int32_t DenseStep::world_row(Eigen::Index column) const {
  const auto k = static_cast<std::size_t>(column);
  return k < own_.rows.size() ? own_.rows[k] : surface_rows_[k - own_.rows.size()].row;
}

void DenseStep::retake_rows(const RowValues& rows) {
  take_rows(rows);
  respond();
}

double DenseStep::known_effort(Eigen::Index column) const {
  const Eigen::Index lasting = memory_.effort.size();
  return column < lasting ? memory_.effort[column]
                          : surface_rows_[static_cast<std::size_t>(column - lasting)].effort;
}

void DenseStep::find_imbalance(std::span<const double> effort) {
  for (Eigen::Index j = 0; j < columns_; ++j) {
    effort_[j] = effort[static_cast<std::size_t>(world_row(j))];
  }
  memory_.effort = effort_.head(memory_.effort.size());
  for (std::size_t k = 0; k < surface_rows_.size(); ++k) {
    surface_rows_[k].effort = effort_[memory_.effort.size() + static_cast<Eigen::Index>(k)];
  }
  scratch_ = right_;
  scratch_.noalias() += rows_.leftCols(columns_) * effort_.head(columns_);
}

double DenseStep::residual(std::span<const double> effort, std::span<double> imbalance) {
  find_imbalance(effort);
  if (!imbalance.empty()) std::copy_n(scratch_.data(), scratch_.size(), imbalance.data());
  return scratch_.norm();
}

void DenseStep::subtract_residual(std::span<const double> force) {
  subtracts_ = !force.empty();
  if (subtracts_) subtracted_ = Eigen::Map<const VectorX>(force.data(), right_.size());
}

Inertia DenseStep::condense() {
  if (motion_.size() == 0) return {};  // a fixed body
  symmetric_ = 0.5 * (matrix_ + matrix_.transpose());
  pivots_.compute(symmetric_);
  Inertia inertia;
  inertia.negative_pivots = pivots_.negative();
  if (pivots_.negative() > 0 && definite_wanted_) {
    make_definite();
    symmetric_ = 0.5 * (matrix_ + matrix_.transpose());
    inertia.negative_pivots = 0;
  }
  decomposed_.compute(matrix_);
  is_symmetric_ = symmetric_ == matrix_;
  if (!is_symmetric_ && !own_.empty()) symmetric_factor_.compute(symmetric_);
  respond();
  if (inertia.at_least() > 0) inertia.status = linalg::FactorStatus::indefinite;
  if (!moved_rows_.leftCols(columns_).allFinite() || pivots_.vanishes()) {
    inertia.status = linalg::FactorStatus::singular;
  }
  return inertia;
}

void DenseStep::add_matrix(int first, std::vector<MatrixEntry>& entries) const {
  for (int j = 0; j < motion_.size(); ++j) {
    for (int i = 0; i < motion_.size(); ++i) {
      if (matrix_(i, j) != 0.0) entries.emplace_back(first + i, first + j, matrix_(i, j));
    }
  }
}

void DenseStep::respond() {
  if (columns_ == 0 || motion_.size() == 0) return;
  const auto rows = rows_.leftCols(columns_);
  decomposed_.solve_columns(rows, moved_rows_.leftCols(columns_));
  decomposed_.solve(right_, motion_);
  free_motion_.head(columns_).noalias() = rows.transpose() * motion_;
  if (is_symmetric_) {
    soft_rows_.leftCols(columns_) = moved_rows_.leftCols(columns_);
  } else {
    symmetric_factor_.solve_columns(rows, soft_rows_.leftCols(columns_));
  }
}

// Negative eigenvalues (buckling directions) change sign, and all are raised to at least softest():
// the program of a law must be convex, and a step must be a descent direction.
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

// The programs of the laws need a symmetric W. They get W_s, that of the symmetric part A_s of A.
// The remainder, H (A^-1 - A_s^-1) H^T lambda at the last known efforts, is added to the free
// motion, so that the law holds for the true motion when Newton's iterations converge. With
// A = A_s + A_a, A_s > 0, the iteration lambda <- lambda - W_s^-1 (W lambda - d) contracts: in the
// metric of A_s, W is the compression of (I + S)^-1 with S skew, whose numerical range is in
// |z - 1/2| <= 1/2. The symmetric part of W would not do: it is softer than W_s by S^2, and with
// nearly redundant joints the iteration diverges.
void DenseStep::add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                               VectorX& free_motion) const {
  if (motion_.size() == 0) return;
  problem_rows_.clear();
  for (Eigen::Index j = 0; j < columns_; ++j) {
    const int at = problem_row[static_cast<std::size_t>(world_row(j))];
    if (at < 0) continue;
    problem_rows_.push_back({j, at, shares_.empty() ? 1.0 : shares_[static_cast<std::size_t>(j)]});
  }
  for (const auto& [j, across, part] : problem_rows_) {
    for (const auto& [i, down, other] : problem_rows_) {
      if (i > j) break;
      const double soft = rows_.col(i).dot(soft_rows_.col(j));
      compliance(down, across) += other * soft * part;
      if (i != j) compliance(across, down) += other * soft * part;
      if (!iterating_) continue;
      free_motion[down] += other * (rows_.col(i).dot(moved_rows_.col(j)) - soft) * known_effort(j);
      if (i == j) continue;
      free_motion[across] += part * (rows_.col(j).dot(moved_rows_.col(i)) - soft) * known_effort(i);
    }
    free_motion[across] += part * free_motion_[j];
  }
}

void DenseStep::solve_motion(std::span<const double> effort) {
  find_imbalance(effort);
  if (motion_.size() > 0) decomposed_.solve(scratch_, motion_);
  depart();
}

void DenseStep::renew(std::span<const double> effort, bool) {
  find_imbalance(effort);
  if (motion_.size() > 0) decomposed_.solve(scratch_, motion_);
}

void DenseStep::add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const {
  if (motion_.size() == 0) return;
  for (Eigen::Index j = 0; j < columns_; ++j) {
    const int at = problem_row[static_cast<std::size_t>(world_row(j))];
    if (at < 0) continue;
    const double share = shares_.empty() ? 1.0 : shares_[static_cast<std::size_t>(j)];
    row_motion[at] += share * rows_.col(j).dot(motion_);
  }
}

Vector3 DenseStep::proposed_motion(int site) const {
  if (motion_.size() == 0) return Vector3::Zero();
  site_jacobian(site, jacobian_);
  return jacobian_ * motion_;
}

void DenseStep::solve(std::span<const double> right, std::span<double> result) {
  if (motion_.size() == 0) return;
  scratch_ = Eigen::Map<const VectorX>(right.data(), motion_.size());
  decomposed_.solve(scratch_, Eigen::Map<VectorX>(result.data(), motion_.size()));
}

void DenseStep::solve_transposed(std::span<const double> right, std::span<double> result) {
  if (motion_.size() == 0) return;
  scratch_ = Eigen::Map<const VectorX>(right.data(), motion_.size());
  decomposed_.solve_transposed(scratch_, Eigen::Map<VectorX>(result.data(), motion_.size()));
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
  const Eigen::Index numbers = 3 * n * n + 3 * rows_.size() + 9 * n;
  return sizeof(double) * static_cast<std::size_t>(numbers);
}

}  // namespace sinew::mechanics
