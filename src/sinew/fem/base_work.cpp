#include "sinew/fem/base_work.hpp"

#include "sinew/fem/fem_body_model.hpp"

namespace sinew::fem {

void count_base_inertia(const FemState& state, const mechanics::StepWeights& weights,
                        mechanics::StepEnd& end) {
  for (const SupportMass& entry : state.model.elements().support_mass()) {
    const Vector3 push = entry.mass * state.combined(weights.acceleration, entry.node);
    const Vector3 moved =
        (state.positions.row(entry.support) - state.start_positions.row(entry.support)).transpose();
    end.external_work += push.dot(moved);
    end.power += push.dot(state.combined(weights.velocity, entry.support));
  }
}

void count_base_force(const FemState& state, const BaseCarry& carry, std::span<const double> force,
                      mechanics::StepEnd& end) {
  const FemBodyModel& model = state.model;
  const auto nodes = model.elements().free_nodes();
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(nodes.size()); ++i) {
    const auto now = state.positions.row(nodes[static_cast<std::size_t>(i)]);
    const auto before = state.start_positions.row(nodes[static_cast<std::size_t>(i)]);
    const Vector3 moved = (now - before).transpose();
    const Eigen::Map<const Vector3> f(force.data() + 3 * i);
    const Vector3 rest = state.base.rest_of(now.transpose());
    end.external_work -= f.dot(moved - carry.strayed(i, moved));
    end.power -= f.dot(value_at(state.base.velocity(), rest));
  }
  for (const NodeId node : model.settings().elements.fixed_nodes) {
    const Vector3 weight = model.weight(node);
    end.external_work -= weight.dot((state.positions.row(node) - state.start_positions.row(node)));
    end.power -= weight.dot(state.velocities.row(node));
  }
}

}  // namespace sinew::fem
