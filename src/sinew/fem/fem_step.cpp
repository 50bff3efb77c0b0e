#include "sinew/fem/fem_step.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/fem/base_work.hpp"
#include "sinew/fem/rounding_floor.hpp"
#include "sinew/fem/tether_force.hpp"

namespace sinew::fem {

namespace {

// A body whose nodes are this many times its size away has blown up.
constexpr double kLargestSize = 1e3;

// Residuals are relative to loads, and at least to the loads of this strain: at rest, there is only
// rounding to compare with.
constexpr double kMinStrain = 1e-5;

std::span<double> span_of(VectorX& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

}  // namespace

FemStep::FemStep(FemState& state, ThreadPool& pool, bool with_geometric_stiffness)
    : state_(state),
      elements_(state, pool, with_geometric_stiffness),
      loads_(state),
      rows_(state.model),
      touched_blocks_(state.model),
      turns_(state.model.elements()),
      inertia_(state) {
  const FemBodyModel& model = state.model;
  const auto nodes = model.elements().free_nodes();
  const auto size = 3 * static_cast<Eigen::Index>(nodes.size());
  for (VectorX* v : {&right_, &motion_, &from_, &imbalance_}) v->setZero(size);
  const double modulus = stiffest_modulus(model.settings().elements);
  min_force_ = kMinStrain * modulus * std::pow(model.elements().volume(), 2.0 / 3.0);
  const Points& positions = state.positions;
  const Vector3 extent = positions.colwise().maxCoeff() - positions.colwise().minCoeff();
  const auto count = static_cast<double>(nodes.size());
  blow_up_ =
      kLargestSize * kLargestSize * count * extent.squaredNorm() + 4.0 * positions.squaredNorm();
}

void FemStep::begin_step() {
  begin_query();
  if (inertia_.base().begin_step()) elements_.moved();
}

void FemStep::begin_query() {
  inertia_.base().begin_query();
  state_.start_positions = state_.positions;
  first_linearisation_ = true;
  elements_.begin_step();
}

void FemStep::linearise(const mechanics::LinearisationRequest& request) {
  tangent_ = request.tangent;
  elements_.linearise(request, first_linearisation_);
  loads_.linearise(request);
  form_right_side(request.weights);
  content_ = Content::other;
  first_linearisation_ = false;
}

// b = p - f - M a - C v, where a and v are combinations of the motion since the start of the step
// and of the state at its start (mechanics::StepWeights).
void FemStep::form_right_side(const mechanics::StepWeights& weights) {
  const FemModel& elements = state_.model.elements();
  const auto nodes = elements.free_nodes();
  const auto forces = elements_.active().assembly.forces();
  double internal = 0.0;
  double outside = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const NodeId node = nodes[i];
    const Eigen::Map<const Vector3> f(forces.data() + k);
    const Vector3 p =
        state_.model.weight(node) +
        (state_.external_forces.row(node) + loads_.forces().row(node) + loads_.drag().row(node))
            .transpose();
    right_.segment<3>(k) = p - f;
    internal += f.squaredNorm();
    outside += p.squaredNorm();
  }
  force_scale_ = state_.stiffness_factor * min_force_ + std::sqrt(internal) + std::sqrt(outside);
  if (state_.tether) force_scale_ += pull(*state_.tether, state_.positions, elements, right_);
  if (subtracts_) right_ -= subtracted_;
  if (weights.dynamic()) {
    force_scale_ += inertia_.add(weights, elements_.active(), first_linearisation_, right_);
  }
  for (const std::int32_t held : elements.held()) right_[held] = 0.0;
}

void FemStep::add_geometric_stiffness(const mechanics::StiffnessPair& pair) {
  SystemWorkspace& workspace = elements_.active();
  touched_blocks_.add(workspace.system, pair.first.number, pair.second.number, pair.hessian,
                      workspace.assembly.matrix());
  elements_.moved();
}

void FemStep::take_rows(const mechanics::RowValues& rows) { rows_.take(rows, elements_.active()); }

mechanics::Inertia FemStep::condense() {
  SystemWorkspace& workspace = elements_.active();
  if (state_.tether) stiffen(*state_.tether, state_.model.elements(), workspace.assembly);
  loads_.stiffen(tangent_, workspace.assembly);
  workspace.assembly.hold();
  workspace.present.reset();
  mechanics::Inertia inertia;
  inertia.status = workspace.factorisation->factorise(workspace.assembly.matrix(), workspace.border,
                                                      span_of(right_));
  content_ = Content::right;
  turned_ = false;
  turns_.start(state_.positions);
  inertia.negative_pivots = workspace.factorisation->negative_pivots();
  inertia.unsymmetric = !loads_.unsymmetric().empty();
  return inertia;
}

void FemStep::add_matrix(int first, std::vector<mechanics::MatrixEntry>& entries) const {
  const SystemWorkspace& workspace = elements_.active();
  const linalg::BlockPattern& pattern = workspace.system.elements->pattern();
  const auto matrix = workspace.assembly.matrix();
  const auto held = state_.model.elements().held();
  const auto add = [&](int i, int j, double value) {
    if (value == 0.0) return;
    if (std::ranges::binary_search(held, i) || std::ranges::binary_search(held, j)) return;
    entries.emplace_back(first + i, first + j, value);
  };
  for (int j = 0; j < pattern.nodes; ++j) {
    const auto begin = static_cast<std::size_t>(j);
    for (auto b = pattern.column_start[begin]; b < pattern.column_start[begin + 1]; ++b) {
      const int i = pattern.row[static_cast<std::size_t>(b)];
      const double* block = matrix.data() + linalg::kBlockStride * static_cast<std::size_t>(b);
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          add(3 * i + r, 3 * j + c, block[4 * c + r]);
          if (i != j) add(3 * j + c, 3 * i + r, block[4 * c + r]);
        }
      }
    }
  }
}

void FemStep::add_compliance(std::span<const int> problem_row, MatrixX& compliance,
                             VectorX& free_motion) const {
  rows_.add_compliance(problem_row, elements_.active(), compliance, free_motion);
}

void FemStep::find_imbalance(std::span<const double> effort) {
  imbalance_ = right_;
  rows_.add_forces(effort, elements_.active(), imbalance_);
}

double FemStep::residual(std::span<const double> effort, std::span<double> imbalance) {
  find_imbalance(effort);
  if (!imbalance.empty()) std::copy_n(imbalance_.data(), imbalance_.size(), imbalance.data());
  return imbalance_.norm();
}

mechanics::Wrench FemStep::unbalanced(std::span<const double> effort, const Vector3& about) {
  find_imbalance(effort);
  mechanics::Wrench sum;
  const auto nodes = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector3 force = imbalance_.segment<3>(3 * static_cast<Eigen::Index>(i));
    sum += {force, (state_.positions.row(nodes[i]).transpose() - about).cross(force)};
  }
  return sum;
}

double FemStep::rounding_floor() const {
  const SystemWorkspace& workspace = elements_.active();
  return fem::rounding_floor(workspace.system.elements->pattern(), workspace.assembly.matrix(),
                             state_.model.elements().held(), state_.positions.cwiseAbs().maxCoeff(),
                             row_sums_);
}

void FemStep::subtract_residual(std::span<const double> force) {
  subtracts_ = !force.empty();
  if (subtracts_) subtracted_ = Eigen::Map<const VectorX>(force.data(), right_.size());
}

// Rows that are not in the border, and unsymmetric terms, need a solution for every right-hand
// side.
void FemStep::renew(std::span<const double> effort, bool turned) {
  linalg::Factorisation& factor = *elements_.active().factorisation;
  find_imbalance(effort);
  turned_ = turned && loads_.unsymmetric().empty();
  if (turned_) turns_.measure(state_.positions);
  if (!rows_.has_transient() && loads_.unsymmetric().empty()) {
    if (turned_) turns_.turn_back(imbalance_);
    factor.renew(span_of(imbalance_));
    const auto own = rows_.fixed_effort(effort);
    base_effort_.assign(own.begin(), own.end());
    content_ = Content::imbalance;
    return;
  }
  content_ = Content::other;
  solve_for_imbalance();
}

void FemStep::solve_for_imbalance() {
  linalg::Factorisation& factor = *elements_.active().factorisation;
  if (turned_) turns_.turn_back(imbalance_);
  factor.solve(span_of(imbalance_), span_of(motion_));
  if (turned_) turns_.turn(motion_);
  correct_for_unsymmetric();
}

void FemStep::correct_for_unsymmetric() {
  if (loads_.unsymmetric().empty()) return;
  correct_for_open_pressure(loads_.unsymmetric(), state_.model.elements().held(),
                            *elements_.active().factorisation, motion_);
}

void FemStep::solve_motion(std::span<const double> effort) {
  linalg::Factorisation& factor = *elements_.active().factorisation;
  const FemBodyModel& model = state_.model;
  const bool in_border = model.rows().size() == model.fixed_rows();
  if (content_ == Content::imbalance) {
    const auto own = rows_.fixed_effort(effort);
    effort_change_.resize(own.size());
    for (std::size_t k = 0; k < own.size(); ++k) effort_change_[k] = own[k] - base_effort_[k];
    factor.solve_with_effort(effort_change_, span_of(motion_));
    if (turned_) turns_.turn(motion_);
  } else if (content_ == Content::right && in_border) {
    factor.solve_with_effort(rows_.fixed_effort(effort), span_of(motion_));
    correct_for_unsymmetric();
  } else {
    find_imbalance(effort);
    solve_for_imbalance();
  }
  leave_from_here();
}

void FemStep::add_row_motions(std::span<const int> problem_row, VectorX& row_motion) const {
  const SystemWorkspace& workspace = elements_.active();
  if (content_ == Content::imbalance) {
    rows_.add_free_motion(problem_row, workspace, row_motion);
  } else {
    rows_.add_motions(problem_row, workspace, motion_, row_motion);
  }
}

void FemStep::solve(std::span<const double> right, std::span<double> result) {
  elements_.active().factorisation->solve(right, result);
}

void FemStep::propose_motion(std::span<const double> motion) {
  std::ranges::copy(motion, motion_.data());
  content_ = Content::other;  // the factor contains another motion
  leave_from_here();
}

void FemStep::propose_drift(double time_step) {
  const FemModel& elements = state_.model.elements();
  const auto nodes = elements.free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    motion_.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        time_step * state_.velocities.row(nodes[i]).transpose();
  }
  for (const std::int32_t held : elements.held()) motion_[held] = 0.0;
  keep_positions();
  departs_ = false;
}

void FemStep::leave_from_here() {
  keep_positions();
  departs_ = true;
}

void FemStep::keep_positions() {
  const auto nodes = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    from_.segment<3>(3 * static_cast<Eigen::Index>(i)) = state_.positions.row(nodes[i]).transpose();
  }
}

Vector3 FemStep::proposed_motion(int point) const {
  const mechanics::Attachment& a = state_.model.attachment(point);
  const auto free = state_.model.elements().free_index();
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < a.nodes.size(); ++k) {
    const auto node = free[static_cast<std::size_t>(a.nodes[k])];
    if (node >= 0) sum += a.weights[k] * motion_.segment<3>(3 * node);
  }
  return sum;
}

void FemStep::add_proposed_motion(Points& nodes) const {
  const auto free = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < free.size(); ++i) {
    nodes.row(free[i]) += motion_.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
  }
}

mechanics::MotionReport FemStep::apply_motion(double scale) {
  if (departs_) elements_.leave_from_here();
  departs_ = false;
  const auto nodes = state_.model.elements().free_nodes();
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const Vector3 moved = from_.segment<3>(k) + scale * motion_.segment<3>(k);
    state_.positions.row(nodes[i]) = moved;
    sum += moved.squaredNorm();
  }
  mechanics::MotionReport report;
  report.largest_move = scale * motion_.cwiseAbs().maxCoeff();
  report.finite = std::isfinite(sum) && sum < blow_up_;
  elements_.moved();
  return report;
}

void FemStep::find_acceleration(const mechanics::StepWeights& weights,
                                std::span<double> acceleration) {
  state_.combine(weights.acceleration, imbalance_);
  std::copy_n(imbalance_.data(), imbalance_.size(), acceleration.data());
}

void FemStep::apply_mass(std::span<const double> motion, std::span<double> result) {
  state_.model.elements().apply_mass(motion, result);
  for (const std::int32_t held : state_.model.elements().held())
    result[static_cast<std::size_t>(held)] = 0.0;
}

mechanics::StepEnd FemStep::end_step(const mechanics::StepWeights& weights) {
  mechanics::StepEnd end;
  count_work(weights, end);
  end.moved_from_outside = state_.tether.has_value() || state_.base.moves();
  const bool carries = state_.base.moves();
  if (carries) carried_force(weights);
  if (carries && weights.dynamic()) count_base_inertia(state_, weights, end);
  elements_.end_step(weights.time_step);
  end.error = state_.end_step(weights);
  if (carries) count_base_force(state_, inertia_.base(), span_of(imbalance_), end);
  return end;
}

// Internal and damping forces of the last linearisation into imbalance_.
void FemStep::carried_force(const mechanics::StepWeights& weights) {
  const auto forces = elements_.active().assembly.forces();
  std::copy_n(forces.data(), imbalance_.size(), imbalance_.data());
  if (weights.dynamic()) inertia_.add_stiffness_damping(weights, elements_.active(), imbalance_);
}

bool FemStep::keeps_linearisation() const {
  return state_.model.elements().solids().empty() && state_.element_history.empty() &&
         !elements_.active().damped;
}

bool FemStep::can_carry_on() const {
  return state_.element_history.size() == 0 && !state_.base.moves();
}

void FemStep::scale_motion(double factor) {
  for (const NodeId node : state_.model.elements().free_nodes()) {
    const auto start = state_.start_positions.row(node);
    state_.positions.row(node) = start + factor * (state_.positions.row(node) - start);
  }
  elements_.moved();
}

void FemStep::add_velocity(std::span<const double> change) {
  const double* next = change.data();
  for (const NodeId node : state_.model.elements().free_nodes()) {
    state_.velocities.row(node) += Eigen::Map<const Eigen::RowVector3d>(next);
    next += 3;
  }
}

void FemStep::count_work(const mechanics::StepWeights& weights, mechanics::StepEnd& end) {
  const RayleighDamping& damping = state_.model.settings().damping;
  if (weights.dynamic() && (damping.mass > 0.0 || damping.stiffness > 0.0)) {
    inertia_.count_damping(weights, elements_.active(), end);
  }
  if (state_.tether) count_tether(weights, end);
  loads_.end_step(weights);
  for (const NodeId node : state_.model.elements().free_nodes()) {
    const Vector3 d = (state_.positions.row(node) - state_.start_positions.row(node)).transpose();
    const Vector3 outside =
        (state_.external_forces.row(node) + loads_.forces().row(node)).transpose();
    const Vector3 drag = loads_.drag().row(node).transpose();
    end.external_work += outside.dot(d);
    end.damped -= drag.dot(d);
    if (!weights.dynamic()) continue;
    const Vector3 v = state_.combined(weights.velocity, node);
    end.power += outside.dot(v);
    end.damping -= drag.dot(v);
  }
}

void FemStep::count_tether(const mechanics::StepWeights& weights, mechanics::StepEnd& end) {
  const mechanics::Tether& tether = *state_.tether;
  const Vector3 now = tether_point(tether, state_.positions);
  const Vector3 force = tether.stiffness * (tether.anchor - now);
  end.external_work += force.dot(now - tether_point(tether, state_.start_positions));
  if (!weights.dynamic()) return;
  for (std::size_t k = 0; k < 3; ++k) {
    end.power += tether.weights[k] * force.dot(state_.combined(weights.velocity, tether.nodes[k]));
  }
}

std::size_t FemStep::bytes() const {
  const Eigen::Index numbers =
      right_.size() + motion_.size() + from_.size() + imbalance_.size() + subtracted_.size();
  return sizeof(double) * static_cast<std::size_t>(numbers) + inertia_.bytes() + elements_.bytes() +
         touched_blocks_.bytes() + turns_.bytes();
}

}  // namespace sinew::fem
