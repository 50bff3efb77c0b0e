// What a FemBody says of its state: saving and restoring it, energies of motion and weight.
#include <algorithm>

#include "sinew/fem/fem_body.hpp"
#include "sinew/fem/fem_body_numbers.hpp"

namespace sinew::fem {

void FemBody::restart() {
  active_->present.reset();
  active_->assembly.linearise_from(nullptr);
  positions_ = model_.mesh().nodes;
  velocities_.setZero();
  for (Points& kept : history_) kept.setZero();
  element_history_.reset();
  prepared_step_.reset();
  base_at_ = Eigen::Isometry3d::Identity();
}

std::size_t FemBody::state_size() const {
  return (2 + history_.size()) * static_cast<std::size_t>(positions_.size()) +
         element_history_.size();
}

void FemBody::save_state(std::span<double> state) const {
  std::copy_n(positions_.data(), positions_.size(), state.data());
  double* to = state.data() + positions_.size();
  to = std::copy_n(velocities_.data(), velocities_.size(), to);
  for (const Points& kept : history_) to = std::copy_n(kept.data(), kept.size(), to);
  element_history_.save({to, element_history_.size()});
}

void FemBody::load_state(std::span<const double> state) {
  active_->present.reset();
  base_at_.reset();
  active_->assembly.linearise_from(nullptr);
  std::copy_n(state.data(), positions_.size(), positions_.data());
  const double* from = state.data() + positions_.size();
  std::copy_n(from, velocities_.size(), velocities_.data());
  for (Points& kept : history_) {
    from += positions_.size();
    std::copy_n(from, kept.size(), kept.data());
  }
  element_history_.load({from + positions_.size(), element_history_.size()});
  prepared_step_.reset();
}

double FemBody::kinetic_energy() {
  const auto nodes = model_.elements().free_nodes();
  travel_.resize(right_.size());
  const auto size = static_cast<std::size_t>(travel_.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    travel_.segment<3>(3 * static_cast<Eigen::Index>(i)) = velocities_.row(nodes[i]).transpose();
  }
  model_.elements().apply_mass({travel_.data(), size}, {scratch_.data(), size});
  return 0.5 * travel_.dot(scratch_);
}

double FemBody::gravity_energy() const {
  double energy = 0.0;
  for (const NodeId node : model_.elements().free_nodes()) {
    const Vector3 moved = (positions_.row(node) - model_.mesh().nodes.row(node)).transpose();
    energy -= weight(node).dot(moved);
  }
  return energy;
}

}  // namespace sinew::fem
