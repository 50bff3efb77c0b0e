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
    : SparseStep(3 * state.model.elements().free_nodes().size(), state.model.row_plan(),
                 state.model.elements().held()),
      state_(state),
      elements_(state, pool, with_geometric_stiffness),
      loads_(state),
      turns_(state.model.elements()),
      inertia_(state) {
  const FemBodyModel& model = state.model;
  const auto nodes = model.elements().free_nodes();
  for (VectorX* v : {&from_, &scratch_}) v->setZero(static_cast<Eigen::Index>(size()));
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

double FemStep::form(const mechanics::LinearisationRequest& request, VectorX& right,
                     mechanics::SparseSystem& system) {
  tangent_ = request.tangent;
  elements_.linearise(request, first_linearisation_);
  loads_.linearise(request);
  const double force_scale = form_right_side(request.weights, right);
  first_linearisation_ = false;
  SystemWorkspace& workspace = elements_.active();
  system = {&workspace.system.elements->pattern(), workspace.assembly.matrix(),
            workspace.factorisation.get()};
  return force_scale;
}

// b = p - f - M a - C v, where a and v are combinations of the motion since the start of the step
// and of the state at its start (mechanics::StepWeights).
double FemStep::form_right_side(const mechanics::StepWeights& weights, VectorX& right) {
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
    right.segment<3>(k) = p - f;
    internal += f.squaredNorm();
    outside += p.squaredNorm();
  }
  double scale = state_.stiffness_factor * min_force_ + std::sqrt(internal) + std::sqrt(outside);
  if (state_.tether) scale += pull(*state_.tether, state_.positions, elements, right);
  if (weights.dynamic()) {
    scale += inertia_.add(weights, elements_.active(), first_linearisation_, right);
  }
  return scale;
}

void FemStep::complete_matrix() {
  SystemWorkspace& workspace = elements_.active();
  if (state_.tether) stiffen(*state_.tether, state_.model.elements(), workspace.assembly);
  loads_.stiffen(tangent_, workspace.assembly);
  workspace.assembly.hold();
  workspace.present.reset();
}

void FemStep::correct(linalg::Factorisation& factor, VectorX& motion, bool transposed) const {
  correct_for_open_pressure(loads_.unsymmetric(), state_.model.elements().held(), factor, motion,
                            transposed);
}

bool FemStep::measure_turns() {
  turns_.measure(state_.positions);
  return true;
}

mechanics::Wrench FemStep::unbalanced(std::span<const double> effort, const Vector3& about) {
  const VectorX& forces = imbalance(effort);
  mechanics::Wrench sum;
  const auto nodes = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector3 force = forces.segment<3>(3 * static_cast<Eigen::Index>(i));
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

void FemStep::drift(double time_step, VectorX& motion) {
  const auto nodes = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    motion.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        time_step * state_.velocities.row(nodes[i]).transpose();
  }
  keep_positions();
  departs_ = false;
}

void FemStep::depart() {
  keep_positions();
  departs_ = true;
}

void FemStep::keep_positions() {
  const auto nodes = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    from_.segment<3>(3 * static_cast<Eigen::Index>(i)) = state_.positions.row(nodes[i]).transpose();
  }
}

void FemStep::add_proposed_motion(Points& nodes) const {
  const auto free = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < free.size(); ++i) {
    nodes.row(free[i]) += motion().segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
  }
}

mechanics::MotionReport FemStep::apply_motion(double scale) {
  if (departs_) elements_.leave_from_here();
  departs_ = false;
  const auto nodes = state_.model.elements().free_nodes();
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = 3 * static_cast<Eigen::Index>(i);
    const Vector3 moved = from_.segment<3>(k) + scale * motion().segment<3>(k);
    state_.positions.row(nodes[i]) = moved;
    sum += moved.squaredNorm();
  }
  mechanics::MotionReport report;
  report.largest_move = scale * motion().cwiseAbs().maxCoeff();
  report.finite = std::isfinite(sum) && sum < blow_up_;
  elements_.moved();
  return report;
}

void FemStep::find_acceleration(const mechanics::StepWeights& weights,
                                std::span<double> acceleration) {
  state_.combine(weights.acceleration, scratch_);
  std::copy_n(scratch_.data(), scratch_.size(), acceleration.data());
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
  if (carries) count_base_force(state_, inertia_.base(), span_of(scratch_), end);
  return end;
}

// Internal and damping forces of the last linearisation into scratch_.
void FemStep::carried_force(const mechanics::StepWeights& weights) {
  const auto forces = elements_.active().assembly.forces();
  std::copy_n(forces.data(), scratch_.size(), scratch_.data());
  if (weights.dynamic()) inertia_.add_stiffness_damping(weights, elements_.active(), scratch_);
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

void FemStep::add_row_forces(std::span<const double> effort, Points& forces) const {
  const auto nodes = state_.model.elements().free_nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    scratch_.segment<3>(3 * static_cast<Eigen::Index>(i)) = forces.row(nodes[i]).transpose();
  }
  SparseStep::add_row_forces(effort, scratch_);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    forces.row(nodes[i]) = scratch_.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
  }
}

std::size_t FemStep::bytes() const {
  const Eigen::Index numbers = from_.size() + scratch_.size() + row_sums_.size();
  return SparseStep::bytes() + sizeof(double) * static_cast<std::size_t>(numbers) +
         inertia_.bytes() + elements_.bytes() + turns_.bytes();
}

}  // namespace sinew::fem
