#include "sinew/mechanics/sparse_step.hpp"

#include <algorithm>

#include "sinew/core/error.hpp"

namespace sinew::mechanics {

namespace {

std::span<double> span_of(VectorX& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

}  // namespace

SparseStep::SparseStep(std::size_t size, const SparseRowPlan& plan,
                       std::span<const std::int32_t> held)
    : held_(held), rows_(plan, held, *this), touched_blocks_(plan.sites().attached, *this) {
  for (VectorX* v : {&right_, &motion_, &imbalance_}) v->setZero(static_cast<Eigen::Index>(size));
}

void SparseStep::linearise(const LinearisationRequest& request) {
  force_scale_ = form(request, right_, system_);
  if (subtracts_) right_ -= subtracted_;
  hold(right_);
  content_ = Content::other;
}

void SparseStep::hold(VectorX& v) const {
  for (const std::int32_t held : held_) v[held] = 0.0;
}

void SparseStep::add_geometric_stiffness(const StiffnessPair& pair) {
  touched_blocks_.add(*system_.pattern, pair.first.number, pair.second.number, pair.hessian,
                      system_.matrix);
  changed_matrix();
}

Inertia SparseStep::condense() {
  complete_matrix();
  Inertia inertia;
  inertia.status = system_.factor->factorise(system_.matrix, rows_.border(), span_of(right_));
  content_ = Content::right;
  turned_ = false;
  keep_directions();
  inertia.negative_pivots = system_.factor->negative_pivots();
  inertia.unsymmetric = !is_symmetric();
  return inertia;
}

void SparseStep::add_matrix(int first, std::vector<MatrixEntry>& entries) const {
  const linalg::BlockPattern& pattern = *system_.pattern;
  const auto add = [&](int i, int j, double value) {
    if (value == 0.0) return;
    if (std::ranges::binary_search(held_, i) || std::ranges::binary_search(held_, j)) return;
    entries.emplace_back(first + i, first + j, value);
  };
  for (int j = 0; j < pattern.nodes; ++j) {
    const auto begin = static_cast<std::size_t>(j);
    for (auto b = pattern.column_start[begin]; b < pattern.column_start[begin + 1]; ++b) {
      const int i = pattern.row[static_cast<std::size_t>(b)];
      const double* block =
          system_.matrix.data() + linalg::kBlockStride * static_cast<std::size_t>(b);
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          add(3 * i + r, 3 * j + c, block[4 * c + r]);
          if (i != j) add(3 * j + c, 3 * i + r, block[4 * c + r]);
        }
      }
    }
  }
}

void SparseStep::add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                                VectorX& free_motion) const {
  rows_.add_compliance(problem_row, *system_.factor, compliance, free_motion);
}

const VectorX& SparseStep::imbalance(std::span<const double> effort) {
  imbalance_ = right_;
  rows_.add_forces(effort, imbalance_);
  return imbalance_;
}

double SparseStep::residual(std::span<const double> effort, std::span<double> copy) {
  const VectorX& sum = imbalance(effort);
  if (!copy.empty()) std::copy_n(sum.data(), sum.size(), copy.data());
  return sum.norm();
}

void SparseStep::subtract_residual(std::span<const double> force) {
  subtracts_ = !force.empty();
  if (subtracts_) subtracted_ = Eigen::Map<const VectorX>(force.data(), right_.size());
}

// Rows that are not in the border, and unsymmetric terms, need a solution for every right-hand
// side.
void SparseStep::renew(std::span<const double> effort, bool turned) {
  imbalance(effort);
  turned_ = turned && is_symmetric() && measure_turns();
  if (rows_.in_border() && is_symmetric()) {
    if (turned_) turn_back(imbalance_);
    system_.factor->renew(span_of(imbalance_));
    const auto own = rows_.persistent_effort(effort);
    base_effort_.assign(own.begin(), own.end());
    content_ = Content::imbalance;
    return;
  }
  content_ = Content::other;
  solve_for_imbalance();
}

void SparseStep::solve_for_imbalance() {
  if (turned_) turn_back(imbalance_);
  system_.factor->solve(span_of(imbalance_), span_of(motion_));
  if (turned_) turn(motion_);
  if (!is_symmetric()) correct(*system_.factor, motion_, false);
}

void SparseStep::solve_motion(std::span<const double> effort) {
  linalg::Factorisation& factor = *system_.factor;
  if (content_ == Content::imbalance) {
    const auto own = rows_.persistent_effort(effort);
    effort_change_.resize(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) effort_change_[k] = own[k] - base_effort_[k];
    factor.solve_with_effort(effort_change_, span_of(motion_));
    if (turned_) turn(motion_);
  } else if (content_ == Content::right && rows_.plan().transient().empty()) {
    factor.solve_with_effort(rows_.persistent_effort(effort), span_of(motion_));
    if (!is_symmetric()) correct(factor, motion_, false);
  } else {
    imbalance(effort);
    solve_for_imbalance();
  }
  depart();
}

void SparseStep::add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const {
  if (content_ == Content::imbalance) {
    rows_.add_free_motion(problem_row, *system_.factor, row_motion);
  } else {
    rows_.add_motions(problem_row, motion_, row_motion);
  }
}

void SparseStep::solve(std::span<const double> right, std::span<double> result) {
  system_.factor->solve(right, result);
}

void SparseStep::solve_transposed(std::span<const double> right, std::span<double> result) {
  VectorX solved = Eigen::Map<const VectorX>(right.data(), motion_.size());
  hold(solved);
  system_.factor->solve(span_of(solved), span_of(solved));
  if (!is_symmetric()) correct(*system_.factor, solved, true);
  std::copy_n(solved.data(), solved.size(), result.data());
}

void SparseStep::propose_motion(std::span<const double> motion) {
  std::ranges::copy(motion, motion_.data());
  content_ = Content::other;  // the factor contains another motion
  depart();
}

void SparseStep::propose_drift(double time_step) {
  drift(time_step, motion_);
  hold(motion_);
  content_ = Content::other;
}

Vector3 SparseStep::proposed_motion(int site) const {
  Vector3 sum = Vector3::Zero();
  for (const SiteBlock& block : rows_.plan().sites().attached[site]) {
    const Vector3 own = motion_.segment<3>(3 * block.block);
    sum += block.weight * (block.turns ? own.cross(lever(site, block.block)) : own);
  }
  return sum;
}

void SparseStep::correct(linalg::Factorisation&, VectorX&, bool) const {
  throw Error(ErrorKind::internal, {}, "a symmetric body is asked for its unsymmetric part");
}

void SparseStep::turn(VectorX&) const {
  throw Error(ErrorKind::internal, {}, "a body that does not measure turns is asked for them");
}

void SparseStep::turn_back(VectorX& v) const { turn(v); }

std::size_t SparseStep::bytes() const {
  const Eigen::Index numbers =
      right_.size() + motion_.size() + imbalance_.size() + subtracted_.size();
  return sizeof(double) * static_cast<std::size_t>(numbers) + rows_.bytes() +
         touched_blocks_.bytes();
}

}  // namespace sinew::mechanics
