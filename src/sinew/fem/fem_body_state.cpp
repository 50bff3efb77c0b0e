// What a FemBody says of its state: saving and restoring it, energies of motion and weight.
#include <algorithm>

#include "sinew/fem/fem_body.hpp"
#include "sinew/fem/fem_body_numbers.hpp"

namespace sinew::fem {

void FemBody::restart() {
  active_->present.reset();
  active_->assembly.linearise_from(nullptr);
  positions_ = model_.mesh().nodes;
  velocities_ = model_.start_velocities();
  for (Points& kept : history_) kept.setZero();
  element_history_.reset();
  prepared_step_.reset();
  rigid_base_.restart();
}

std::size_t FemBody::state_size() const {
  return (2 + history_.size()) * static_cast<std::size_t>(positions_.size()) +
         element_history_.size() + rigid_base_.state_size();
}

void FemBody::save_state(std::span<double> state) const {
  std::copy_n(positions_.data(), positions_.size(), state.data());
  double* to = state.data() + positions_.size();
  to = std::copy_n(velocities_.data(), velocities_.size(), to);
  for (const Points& kept : history_) to = std::copy_n(kept.data(), kept.size(), to);
  element_history_.save({to, element_history_.size()});
  rigid_base_.save_state({to + element_history_.size(), rigid_base_.state_size()});
}

void FemBody::load_state(std::span<const double> state) {
  active_->present.reset();
  active_->assembly.linearise_from(nullptr);
  std::copy_n(state.data(), positions_.size(), positions_.data());
  const double* from = state.data() + positions_.size();
  std::copy_n(from, velocities_.size(), velocities_.data());
  for (Points& kept : history_) {
    from += positions_.size();
    std::copy_n(from, kept.size(), kept.data());
  }
  from += positions_.size();
  element_history_.load({from, element_history_.size()});
  rigid_base_.load_state({from + element_history_.size(), rigid_base_.state_size()});
  prepared_step_.reset();
}

double FemBody::kinetic_energy() {
  const FemModel& elements = model_.elements();
  const auto nodes = elements.free_nodes();
  travel_.resize(right_.size());
  const auto size = static_cast<std::size_t>(travel_.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    travel_.segment<3>(3 * static_cast<Eigen::Index>(i)) = velocities_.row(nodes[i]).transpose();
  }
  elements.apply_mass({travel_.data(), size}, {scratch_.data(), size});
  double energy = 0.5 * travel_.dot(scratch_);
  const auto free = elements.free_index();
  for (const SupportMass& entry : elements.support_mass()) {
    // M_fb stands for M_bf, too.
    const double share = free[static_cast<std::size_t>(entry.node)] >= 0 ? 1.0 : 0.5;
    energy += share * entry.mass * velocities_.row(entry.node).dot(velocities_.row(entry.support));
  }
  return energy;
}

double FemBody::gravity_energy() const {
  const Points& rest = model_.mesh().nodes;
  double energy = 0.0;
  for (NodeId node = 0; node < static_cast<NodeId>(rest.rows()); ++node) {
    energy -= weight(node).dot((positions_.row(node) - rest.row(node)).transpose());
  }
  return energy;
}

}  // namespace sinew::fem
