#include "sinew/fem/base_carry.hpp"

#include "sinew/fem/fem_body_model.hpp"

namespace sinew::fem {

// All nodes of elements follow the base rigidly, without strain; a step begins its search there.
// The fixed nodes are then placed exactly, so that rounding does not accumulate.
bool BaseCarry::begin_step() {
  const RigidBase& base = state_.base;
  carried_ = state_.base.begin_step();
  if (!carried_) return false;
  const FemBodyModel& model = state_.model;
  const auto nodes = model.elements().free_nodes();
  carry_.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector3 at = state_.positions.row(nodes[i]).transpose();
    const Vector3 to = base.place(base.rest_of(at));
    carry_.segment<3>(3 * static_cast<Eigen::Index>(i)) = to - at;
    state_.positions.row(nodes[i]) = to.transpose();
  }
  const Points& rest = model.mesh().nodes;
  for (const NodeId node : model.settings().elements.fixed_nodes) {
    state_.positions.row(node) = base.place(rest.row(node).transpose()).transpose();
  }
  return true;
}

// A rigid motion w of all nodes has K w = 0, so K_fb v_b = -K_ff w_f, and damping acts on v_f -
// w_f. The position of the free nodes in the frame of the base is extrapolated by their velocity in
// it, which keeps the second order of the integrators. It is constant in Newton's iterations.
void BaseCarry::find_velocity(const mechanics::StepWeights& weights) {
  const RigidBase& base = state_.base;
  moves_ = base.moves();
  if (!moves_) return;
  const AffineField field = base.combine(weights.velocity);
  const auto nodes = state_.model.elements().free_nodes();
  velocity_.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Vector3 rest = base.rest_of(state_.start_positions.row(nodes[i]).transpose());
    const Vector3 slip =
        state_.velocities.row(nodes[i]).transpose() - value_at(base.velocity(), rest);
    rest += weights.time_step * base.turn_back(slip);
    velocity_.segment<3>(3 * static_cast<Eigen::Index>(i)) = value_at(field, rest);
  }
}

void BaseCarry::subtract_velocity(VectorX& velocity) const {
  if (moves_) velocity -= velocity_;
}

void BaseCarry::add_momentum(const mechanics::Combination& weights, VectorX& forces) const {
  if (!state_.base.moves()) return;
  const auto free = state_.model.elements().free_index();
  for (const SupportMass& entry : state_.model.elements().support_mass()) {
    const auto i = free[static_cast<std::size_t>(entry.node)];
    if (i >= 0) forces.segment<3>(3 * i) += entry.mass * state_.combined(weights, entry.support);
  }
}

}  // namespace sinew::fem
