#include "sinew/fem/fem_body.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/fem/fem_body_numbers.hpp"
#include "sinew/linalg/block_product.hpp"

namespace sinew::fem {

namespace {

// A body whose nodes are this many of its sizes away has blown up.
constexpr double kLargestSize = 1e3;

// Residuals are judged relative to loads, but not to loads that strain a body less than this: at
// rest there is nothing but rounding to compare with.
constexpr double kLeastStrain = 1e-5;

std::span<double> span_of(VectorX& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
}  // namespace

FemBody::FemBody(const FemBodyModel& model, ThreadPool& pool, bool with_curvature, int histories)
    : model_(model),
      pool_(pool),
      positions_(model.mesh().nodes),
      velocities_(model.start_velocities()),
      external_forces_(Points::Zero(positions_.rows(), 3)),
      history_(static_cast<std::size_t>(histories), external_forces_),
      load_factors_(model.loads().size(), 1.0),
      load_forces_(Points::Zero(positions_.rows(), 3)),
      drag_forces_(load_forces_),
      element_history_(model.elements().solids()),
      start_positions_(positions_),
      active_(&numbers(with_curvature)),
      rigid_base_(histories) {
  const auto nodes = model.elements().free_nodes();
  const auto size = 3 * static_cast<Eigen::Index>(nodes.size());
  for (VectorX* v : {&right_, &motion_, &base_, &scratch_}) v->setZero(size);
  row_effort_.resize(model.fixed_rows());
  passing_.reserve((model.rows().size() - model.fixed_rows()) / 3);
  double modulus = 0.0;
  for (const Region& region : model.settings().elements.regions) {
    modulus = std::max(modulus, region.young_modulus());
  }
  least_force_ = kLeastStrain * modulus * std::pow(model.elements().volume(), 2.0 / 3.0);
  const Vector3 extent = positions_.colwise().maxCoeff() - positions_.colwise().minCoeff();
  const auto count = static_cast<double>(nodes.size());
  blow_up_ =
      kLargestSize * kLargestSize * count * extent.squaredNorm() + 4.0 * positions_.squaredNorm();
}

FemBody::~FemBody() = default;

FemBody::Numbers& FemBody::numbers(bool with_curvature) {
  const FemSystem& system = model_.system(with_curvature);
  auto& own = &system == &model_.system(false) ? plain_ : curved_;
  if (!own) {
    own = std::make_unique<Numbers>(system, pool_);
    if (!element_history_.empty()) own->assembly.set_history(&element_history_);
  }
  return *own;
}

void FemBody::prepare_history(double time_step) {
  if (element_history_.empty() || prepared_step_ == time_step) return;
  element_history_.begin_step(time_step);
  prepared_step_ = time_step;
}

Vector3 FemBody::weighted(const Points& field, int point) const {
  const auto& a = model_.attachment(point);
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    sum += a.weights[k] * field.row(a.nodes[k]).transpose();
  }
  return sum;
}

Vector3 FemBody::position(int point) const { return weighted(positions_, point); }
Vector3 FemBody::velocity(int point) const { return weighted(velocities_, point); }

void FemBody::begin_step() {
  begin_query();
  place_base();
}

void FemBody::begin_query() {
  carried_ = false;
  start_positions_ = positions_;
  first_linearisation_ = true;
  prepared_step_.reset();
  // What the last step's motion lent the tangent's pressure must not outlive it: a state says all.
  if (active_->assembly.linearise_from(nullptr)) active_->present.reset();
}

void FemBody::linearise(const mechanics::LinearisationRequest& request) {
  Numbers* const before = active_;
  active_ = &numbers(request.with_curvature);
  if (active_ != before) before->present.reset();
  tangent_ = request.tangent;
  active_->iterating = request.iterating;
  prepare_history(request.weights.time_step);
  evaluate_elements(request);
  if (!model_.loads().empty()) apply_loads(request);
  form_right_side(request);
  first_linearisation_ = false;
}

namespace {

Tangent element_tangent(mechanics::Tangent tangent) {
  switch (tangent) {
    case mechanics::Tangent::real_time:
      return Tangent::rotated;
    case mechanics::Tangent::projected:
      return Tangent::projected;
    case mechanics::Tangent::exact:
      return Tangent::exact;
  }
  return Tangent::exact;
}

}  // namespace

// C = alpha M + beta K with the rotated K at the start of the step: positive semi-definite, so that
// damping damps, and constant, so that Newton's derivative is exact. Softening has no part in it:
// where a step ends at the largest strain so far its slope jumps, and rounding would decide.
void FemBody::evaluate_elements(const mechanics::LinearisationRequest& request) {
  const auto& weights = request.weights;
  const auto& damping = model_.settings().damping;
  const double mass = weights.acceleration.motion + damping.mass * weights.velocity.motion;
  const double rate = damping.stiffness * weights.velocity.motion;
  const AssemblyWeights wanted{element_tangent(request.tangent), 1.0, mass};
  active_->damped = rate > 0.0;
  if (active_->damped && first_linearisation_) {
    active_->assembly.evaluate(positions_, {Tangent::rotated, 1.0, 0.0, false});
    const auto matrix = active_->assembly.matrix();
    active_->start_stiffness.assign(matrix.begin(), matrix.end());
    active_->present.reset();
  }
  const bool historic = !element_history_.empty();
  if (active_->present == wanted && !historic && !active_->damped) return;
  active_->assembly.evaluate(positions_, wanted);
  active_->present = wanted;
  if (!active_->damped) return;
  const auto matrix = active_->assembly.matrix();
  for (std::size_t i = 0; i < matrix.size(); ++i) matrix[i] += rate * active_->start_stiffness[i];
}

// b = p - f - M a - C v, a and v combinations of the motion since the step began and of what was
// before it (mechanics::StepWeights).
void FemBody::form_right_side(const mechanics::LinearisationRequest& request) {
  const auto nodes = model_.elements().free_nodes();
  const auto forces = active_->assembly.forces();
  double internal = 0.0;
  double outside = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const Eigen::Map<const Vector3> f(forces.data() + k);
    const Vector3 p = weight(nodes[i]) + (external_forces_.row(nodes[i]) +
                                          load_forces_.row(nodes[i]) + drag_forces_.row(nodes[i]))
                                             .transpose();
    right_.segment<3>(k) = p - f;
    internal += f.squaredNorm();
    outside += p.squaredNorm();
  }
  force_scale_ = least_force_ + std::sqrt(internal) + std::sqrt(outside);
  if (tether_) pull_by_tether();
  if (imbalance_share_ != 0.0) right_ -= imbalance_share_ * imbalance_;
  const auto& weights = request.weights;
  if (!weights.dynamic()) return hold_right_side();
  add_inertia(weights);
  hold_right_side();
}

Vector3 FemBody::combined(const mechanics::Combination& weights, NodeId node) const {
  Vector3 sum = weights.velocity * velocities_.row(node).transpose() +
                weights.motion * (positions_.row(node) - start_positions_.row(node)).transpose();
  const bool kept = !history_.empty() && (weights.first != 0.0 || weights.second != 0.0);
  if (!kept) return sum;
  sum += weights.first * history_[0].row(node).transpose() +
         weights.second * history_[1].row(node).transpose();
  return sum;
}

void FemBody::combine(const mechanics::Combination& weights, VectorX& result) const {
  const auto nodes = model_.elements().free_nodes();
  result.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    result.segment<3>(3 * static_cast<Eigen::Index>(i)) = combined(weights, nodes[i]);
  }
}

void FemBody::add_inertia(const mechanics::StepWeights& weights) {
  const auto& damping = model_.settings().damping;
  const auto sum = [&](double a, double v) { return -(a + damping.mass * v); };
  const mechanics::Combination &a = weights.acceleration, &v = weights.velocity;
  const mechanics::Combination inertia{sum(a.motion, v.motion), sum(a.velocity, v.velocity),
                                       sum(a.first, v.first), sum(a.second, v.second)};
  combine(inertia, momentum_);
  active_->system.elements->apply_mass(span_of(momentum_), span_of(scratch_));
  add_base_momentum(inertia, scratch_);
  right_ += scratch_;
  force_scale_ += scratch_.norm();
  if (!active_->damped) return;
  if (first_linearisation_) find_base_velocity(weights);
  combine_velocity(weights, travel_);
  linalg::multiply(active_->system.elements->pattern(), active_->start_stiffness, span_of(travel_),
                   span_of(scratch_));
  right_ -= damping.stiffness * scratch_;
}

void FemBody::hold_right_side() {
  for (const std::int32_t held : model_.elements().held()) right_[held] = 0.0;
}

void FemBody::add_curvature(const mechanics::RowCurvature& curvature) {
  const auto& first = model_.attachment(curvature.first.point);
  const auto& second = model_.attachment(curvature.second.point);
  const bool same = curvature.first.point == curvature.second.point;
  const auto free = model_.elements().free_index();
  for (std::size_t a = 0; a < first.nodes.size(); ++a) {
    const auto i = free[static_cast<std::size_t>(first.nodes[a])];
    if (i < 0) continue;
    for (std::size_t b = 0; b < second.nodes.size(); ++b) {
      const auto j = free[static_cast<std::size_t>(second.nodes[b])];
      if (j < 0 || (same && i < j)) continue;
      Matrix3 block = -first.weights[a] * second.weights[b] * curvature.curvature;
      // Off-diagonal pairs stand for themselves and their transpose.
      if (!same && i == j) block = (block + block.transpose()).eval();
      active_->assembly.add_block(i, j, block);
    }
  }
  active_->present.reset();
}

// A += stiffness w_a w_b I at the blocks of its nodes.
void FemBody::stiffen_by_tether() {
  const auto free = model_.elements().free_index();
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      const double weight = tether_->weights[a] * tether_->weights[b];
      const auto i = free[static_cast<std::size_t>(tether_->nodes[a])];
      const auto j = free[static_cast<std::size_t>(tether_->nodes[b])];
      if (weight == 0.0 || i < 0 || j < 0) continue;
      active_->assembly.add_block(i, j, tether_->stiffness * weight * Matrix3::Identity());
    }
  }
}

void FemBody::take_rows(const mechanics::RowValues& rows) {
  std::ranges::fill(active_->border, 0.0);
  for (const auto& s : active_->system.scatter) {
    double* value = active_->border.data() + 3 * static_cast<std::size_t>(s.position);
    const Vector3& direction = rows.direction[static_cast<std::size_t>(s.entry)];
    for (int c = 0; c < 3; ++c) value[c] += s.weight * direction[c];
  }
  take_presence(rows);
  const auto held = model_.elements().held();
  if (held.empty()) return;
  for (std::size_t e = 0; e < active_->system.border.node.size(); ++e) {
    for (int c = 0; c < 3; ++c) {
      const std::int32_t coordinate = 3 * active_->system.border.node[e] + c;
      if (std::ranges::binary_search(held, coordinate)) {
        active_->border[3 * e + static_cast<std::size_t>(c)] = 0.0;
      }
    }
  }
}

void FemBody::take_presence(const mechanics::RowValues& rows) {
  passing_.clear();
  const auto& own = model_.rows();
  for (std::size_t k = model_.fixed_rows(); k < own.size(); k += 3) {
    if (rows.present[static_cast<std::size_t>(own[k])] == 0) continue;
    passing_.push_back(static_cast<std::int32_t>((k - model_.fixed_rows()) / 3));
  }
}

Vector3 FemBody::proposed_motion(int point) const {
  const auto& a = model_.attachment(point);
  const auto free = model_.elements().free_index();
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    const auto node = free[static_cast<std::size_t>(a.nodes[k])];
    if (node >= 0) sum += a.weights[k] * motion_.segment<3>(3 * node);
  }
  return sum;
}

double FemBody::residual(std::span<const double> effort) {
  scratch_ = right_;
  const auto& border = active_->system.border;
  for (std::size_t k = 0; k < model_.rows().size(); ++k) {
    const double lambda = effort[static_cast<std::size_t>(model_.rows()[k])];
    if (lambda == 0.0) continue;
    for (auto e = border.row_start[k]; e < border.row_start[k + 1]; ++e) {
      const double* value = active_->border.data() + 3 * static_cast<std::size_t>(e);
      double* r = scratch_.data() + 3 * border.node[static_cast<std::size_t>(e)];
      for (int c = 0; c < 3; ++c) r[c] += lambda * value[c];
    }
  }
  return scratch_.norm();
}

void FemBody::add_row_forces(std::span<const double> effort, Points& forces) const {
  const auto& border = active_->system.border;
  for (std::size_t k = 0; k < model_.rows().size(); ++k) {
    const double lambda = effort[static_cast<std::size_t>(model_.rows()[k])];
    for (auto e = border.row_start[k]; e < border.row_start[k + 1]; ++e) {
      const Eigen::Map<const Vector3> value(active_->border.data() +
                                            3 * static_cast<std::size_t>(e));
      const auto free = static_cast<std::size_t>(border.node[static_cast<std::size_t>(e)]);
      forces.row(model_.elements().free_nodes()[free]) += lambda * value.transpose();
    }
  }
}

void FemBody::hold_imbalance(std::span<const double> effort) {
  residual(effort);
  imbalance_ = scratch_;
}

linalg::FactorStatus FemBody::condense() {
  if (tether_) stiffen_by_tether();
  stiffen_by_loads();
  active_->assembly.hold();
  active_->present.reset();
  const std::span<const double> border(active_->border);
  return active_->factorisation->factorise(
      active_->assembly.matrix(), border.first(3 * active_->system.fixed_entries), span_of(right_));
}

void FemBody::add_compliance(std::span<const int> place, MatrixX& compliance,
                             VectorX& free_motion) const {
  const MatrixX& own = active_->factorisation->compliance();
  const VectorX& motion = active_->factorisation->free_motion();
  const std::span<const std::int32_t> rows(model_.rows());
  const std::size_t fixed = model_.fixed_rows();
  const auto place_of = [&](std::size_t i) { return place[static_cast<std::size_t>(rows[i])]; };
  for (std::size_t j = 0; j < fixed; ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const int to = place_of(j);
    free_motion[to] += motion[column];
    for (std::size_t i = 0; i < fixed; ++i) {
      compliance(place_of(i), to) += own(static_cast<Eigen::Index>(i), column);
    }
  }
  if (!passing_.empty()) add_passing_compliance(place, compliance, free_motion);
}

void FemBody::add_passing_compliance(std::span<const int> place, MatrixX& compliance,
                                     VectorX& free_motion) const {
  const std::span<const double> border(active_->border);
  active_->factorisation->pass(border.subspan(3 * active_->system.fixed_entries), passing_);
  const MatrixX& own = active_->factorisation->passing_compliance();
  const MatrixX& coupling = active_->factorisation->passing_coupling();
  const std::span<const std::int32_t> rows(model_.rows());
  const std::size_t fixed = model_.fixed_rows();
  const auto row_of = [&](Eigen::Index k) {
    const auto group = static_cast<std::size_t>(passing_[static_cast<std::size_t>(k / 3)]);
    const std::int32_t row = rows[fixed + 3 * group + static_cast<std::size_t>(k % 3)];
    return place[static_cast<std::size_t>(row)];
  };
  const auto count = 3 * static_cast<Eigen::Index>(passing_.size());
  for (Eigen::Index j = 0; j < count; ++j) {
    const int column = row_of(j);
    free_motion[column] += coupling(j, static_cast<Eigen::Index>(fixed));
    for (std::size_t i = 0; i < fixed; ++i) {
      const double value = coupling(j, static_cast<Eigen::Index>(i));
      const int to = place[static_cast<std::size_t>(rows[i])];
      compliance(to, column) += value;
      compliance(column, to) += value;
    }
    compliance(column, column) += own(j, j);
    for (Eigen::Index i = j + 1; i < count; ++i) {
      const int row = row_of(i);
      compliance(row, column) += own(i, j);
      compliance(column, row) += own(i, j);
    }
  }
}

void FemBody::solve_motion(std::span<const double> effort) {
  if (model_.rows().size() > model_.fixed_rows()) {
    residual(effort);
    active_->factorisation->solve(span_of(scratch_), span_of(motion_));
  } else {
    for (std::size_t k = 0; k < row_effort_.size(); ++k) {
      row_effort_[k] = effort[static_cast<std::size_t>(model_.rows()[k])];
    }
    active_->factorisation->solve_with_effort(row_effort_, span_of(motion_));
  }
  if (!open_stiffness_.empty()) correct_for_open_pressure();
  remember_base();
}

void FemBody::remember_base() {
  keep_positions();
  if (active_->iterating) active_->assembly.linearise_from(&positions_);
}

void FemBody::keep_positions() {
  const auto nodes = model_.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    base_.segment<3>(3 * static_cast<Eigen::Index>(i)) = positions_.row(nodes[i]).transpose();
  }
}

void FemBody::imbalance(std::span<const double> effort, std::span<double> result) {
  residual(effort);
  std::copy_n(scratch_.data(), scratch_.size(), result.data());
}

void FemBody::solve(std::span<const double> right, std::span<double> result) {
  active_->factorisation->solve(right, result);
}

void FemBody::propose_motion(std::span<const double> motion) {
  std::ranges::copy(motion, motion_.data());
  remember_base();
}

void FemBody::propose_drift(double time_step) {
  const auto nodes = model_.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    motion_.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        time_step * velocities_.row(nodes[i]).transpose();
  }
  for (const std::int32_t held : model_.elements().held()) motion_[held] = 0.0;
  keep_positions();
}

mechanics::MotionReport FemBody::apply_motion(double scale) {
  const auto nodes = model_.elements().free_nodes();
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const Vector3 moved = base_.segment<3>(k) + scale * motion_.segment<3>(k);
    positions_.row(nodes[i]) = moved;
    sum += moved.squaredNorm();
  }
  mechanics::MotionReport report;
  report.largest_move = scale * motion_.cwiseAbs().maxCoeff();
  report.finite = std::isfinite(sum) && sum < blow_up_;
  active_->present.reset();
  return report;
}

mechanics::SmallestVolume FemBody::smallest_volume() {
  const Assembly& assembly = active_->assembly;
  if (active_->present) return {assembly.minimum_volume_ratio(), assembly.worst_element()};
  const auto volume = active_->assembly.measure_volume(positions_);
  return {volume.smallest_ratio, volume.element};
}

double FemBody::end_step(const mechanics::StepWeights& weights) {
  using Jump = mechanics::StepWeights::Jump;
  add_work(weights);
  if (!element_history_.empty()) {
    prepare_history(weights.time_step);
    active_->assembly.advance(positions_, element_history_);
    prepared_step_.reset();
  }
  rigid_base_.end_step(weights);
  if (!weights.dynamic()) {  // nothing moves, and nothing is kept
    velocities_.setZero();
    for (Points& kept : history_) kept.setZero();
    return 0.0;
  }
  double worst = 0.0;
  const bool kept = !history_.empty();
  for (Eigen::Index i = 0; i < positions_.rows(); ++i) {
    const Vector3 d = (positions_.row(i) - start_positions_.row(i)).transpose();
    const Vector3 before = velocities_.row(i).transpose();
    const Vector3 h0 = kept ? Vector3(history_[0].row(i).transpose()) : Vector3::Zero();
    const Vector3 h1 = kept ? Vector3(history_[1].row(i).transpose()) : Vector3::Zero();
    const auto sum = [&](const mechanics::Combination& c) -> Vector3 {
      return c.motion * d + c.velocity * before + c.first * h0 + c.second * h1;
    };
    const Vector3 velocity = sum(weights.velocity);
    velocities_.row(i) = velocity.transpose();
    if (kept) {
      history_[0].row(i) = sum(weights.first).transpose();
      history_[1].row(i) = sum(weights.second).transpose();
    }
    Vector3 jump = Vector3::Zero();
    if (weights.error_of == Jump::velocity) jump = velocity - before;
    if (weights.error_of == Jump::first) jump = sum(weights.first) - h0;
    if (weights.error_of == Jump::acceleration) {
      jump = sum(weights.acceleration) - (before - h1) / weights.step_before;
    }
    worst = std::max(worst, jump.squaredNorm());
  }
  return weights.error_jump * std::sqrt(worst);
}

int FemBody::negative_pivots() const { return active_->factorisation->negative_pivots(); }

double FemBody::strain_energy() {
  // What relaxing parts store beside the law's energy is not in it.
  prepare_history(0.0);
  const bool present = active_->present.has_value() && element_history_.empty();
  if (!present) active_->assembly.evaluate(positions_, {Tangent::none, 1.0, 0.0});
  return active_->assembly.strain_energy();
}

std::size_t FemBody::bytes() const {
  const Eigen::Index free = right_.size() + motion_.size() + base_.size() + scratch_.size() +
                            travel_.size() + momentum_.size() + imbalance_.size() + carry_.size() +
                            base_velocity_.size();
  const auto points = (4 + history_.size()) * static_cast<std::size_t>(positions_.size());
  auto total = sizeof(double) * (points + static_cast<std::size_t>(free) + element_history_.size());
  for (const Numbers* n : {plain_.get(), curved_.get()}) {
    if (n == nullptr) continue;
    total += n->assembly.bytes() + n->factorisation->bytes() +
             sizeof(double) * (n->border.size() + n->start_stiffness.size());
  }
  return total;
}

}  // namespace sinew::fem
