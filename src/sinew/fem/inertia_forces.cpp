#include "sinew/fem/inertia_forces.hpp"

#include "sinew/linalg/block_product.hpp"

namespace sinew::fem {

namespace {

std::span<double> view(VectorX& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

}  // namespace

void InertiaForces::multiply_by_mass(const FemModel& elements) {
  force_.resize(motion_.size());
  elements.apply_mass(view(motion_), view(force_));
}

void InertiaForces::multiply_by_stiffness(const SystemWorkspace& workspace) {
  force_.resize(motion_.size());
  linalg::multiply(workspace.system.elements->pattern(), workspace.damping_stiffness, view(motion_),
                   view(force_));
}

double InertiaForces::add(const mechanics::StepWeights& weights, const SystemWorkspace& workspace,
                          bool first, VectorX& right) {
  const RayleighDamping& damping = state_.model.settings().damping;
  const auto sum = [&](double a, double v) { return -(a + damping.mass * v); };
  const mechanics::Combination &a = weights.acceleration, &v = weights.velocity;
  const mechanics::Combination inertia{sum(a.motion, v.motion), sum(a.velocity, v.velocity),
                                       sum(a.first, v.first), sum(a.second, v.second)};
  state_.combine(inertia, motion_);
  multiply_by_mass(*workspace.system.elements);
  base_.add_momentum(inertia, force_);
  right += force_;
  const double size = force_.norm();
  if (!workspace.damped) return size;
  if (first) base_.find_velocity(weights);
  damp(weights, workspace);
  right -= damping.stiffness * force_;
  return size;
}

// K u into force_, with the velocities relative to the base in motion_.
void InertiaForces::damp(const mechanics::StepWeights& weights, const SystemWorkspace& workspace) {
  state_.combine(weights.velocity, motion_);
  base_.subtract_velocity(motion_);
  multiply_by_stiffness(workspace);
}

void InertiaForces::add_stiffness_damping(const mechanics::StepWeights& weights,
                                          const SystemWorkspace& workspace, VectorX& force) {
  if (!workspace.damped) return;
  damp(weights, workspace);
  force += state_.model.settings().damping.stiffness * force_;
}

// (C v) . d with C = alpha M + beta K of the step. K acts on velocities relative to the base, and
// dissipates in the motion relative to the base; the rest of its work is done by the base.
void InertiaForces::count_damping(const mechanics::StepWeights& weights,
                                  const SystemWorkspace& workspace, mechanics::StepEnd& end) {
  const RayleighDamping& damping = state_.model.settings().damping;
  const auto nodes = state_.model.elements().free_nodes();
  const auto moved = [&](std::int32_t i) -> Vector3 {
    const NodeId node = nodes[static_cast<std::size_t>(i)];
    return (state_.positions.row(node) - state_.start_positions.row(node)).transpose();
  };
  const auto strayed = [&](std::int32_t i) { return base_.strayed(i, moved(i)); };
  const auto along = [&](const auto& motion) {
    double sum = 0.0;
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(nodes.size()); ++i) {
      sum += force_.segment<3>(3 * i).dot(motion(i));
    }
    return sum;
  };
  if (damping.mass > 0.0) {
    state_.combine(weights.velocity, motion_);
    multiply_by_mass(*workspace.system.elements);
    base_.add_momentum(weights.velocity, force_);
    end.damped += damping.mass * along(moved);
    end.damping += damping.mass * force_.dot(motion_);
  }
  if (!workspace.damped) return;
  damp(weights, workspace);
  end.damped += damping.stiffness * along(strayed);
  end.damping += damping.stiffness * force_.dot(motion_);
}

double InertiaForces::kinetic_energy() {
  const FemModel& elements = state_.model.elements();
  const auto nodes = elements.free_nodes();
  motion_.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    motion_.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        state_.velocities.row(nodes[i]).transpose();
  }
  multiply_by_mass(elements);
  double energy = 0.5 * motion_.dot(force_);
  const auto free = elements.free_index();
  for (const SupportMass& entry : elements.support_mass()) {
    // M_fb also represents M_bf.
    const double share = free[static_cast<std::size_t>(entry.node)] >= 0 ? 1.0 : 0.5;
    energy += share * entry.mass *
              state_.velocities.row(entry.node).dot(state_.velocities.row(entry.support));
  }
  return energy;
}

}  // namespace sinew::fem
