// What FemBody does with the motion of its fixed nodes.
#include "sinew/fem/fem_body.hpp"
#include "sinew/fem/fem_body_numbers.hpp"

namespace sinew::fem {

// All nodes of elements follow the base rigidly, which strains nothing and is where a step begins
// its search; then the fixed ones stand where they must, without rounding adding up.
void FemBody::place_base() {
  carried_ = rigid_base_.begin_step();
  if (!carried_) return;
  active_->present.reset();
  const auto nodes = model_.elements().free_nodes();
  carry_.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector3 at = positions_.row(nodes[i]).transpose();
    const Vector3 to = rigid_base_.place(rigid_base_.rest_of(at));
    carry_.segment<3>(3 * static_cast<Eigen::Index>(i)) = to - at;
    positions_.row(nodes[i]) = to.transpose();
  }
  const Points& rest = model_.mesh().nodes;
  for (const NodeId node : model_.settings().elements.fixed_nodes) {
    positions_.row(node) = rigid_base_.place(rest.row(node).transpose()).transpose();
  }
}

// The base's velocity, extended rigidly to where the free nodes will be. K of a rigid motion is
// zero over all nodes, so that K_fb v_b = -K_ff w with w this field: damping acts on v_f - w. Their
// place in the base's frame is extrapolated by their velocity in it, to the second order of the
// integrators, and stays what it is in Newton's iterations.
void FemBody::find_base_velocity(const mechanics::StepWeights& weights) {
  base_moves_ = rigid_base_.moves();
  if (!base_moves_) return;
  const AffineField field = rigid_base_.combine(weights.velocity);
  const auto nodes = model_.elements().free_nodes();
  base_velocity_.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Vector3 rest = rigid_base_.rest_of(start_positions_.row(nodes[i]).transpose());
    const Vector3 slip =
        velocities_.row(nodes[i]).transpose() - value_at(rigid_base_.velocity(), rest);
    rest += weights.time_step * rigid_base_.turn_back(slip);
    base_velocity_.segment<3>(3 * static_cast<Eigen::Index>(i)) = value_at(field, rest);
  }
}

// Velocity at the end of the step that stiffness damping acts on.
void FemBody::combine_velocity(const mechanics::StepWeights& weights, VectorX& result) const {
  combine(weights.velocity, result);
  if (base_moves_) result -= base_velocity_;
}

// M_fb times a combination of the base nodes' motion, added to forces on free nodes.
void FemBody::add_base_momentum(const mechanics::Combination& weights, VectorX& result) const {
  if (!rigid_base_.moves()) return;
  const auto free = model_.elements().free_index();
  for (const SupportMass& entry : model_.elements().support_mass()) {
    const auto i = free[static_cast<std::size_t>(entry.node)];
    if (i >= 0) result.segment<3>(3 * i) += entry.mass * combined(weights, entry.support);
  }
}

}  // namespace sinew::fem
