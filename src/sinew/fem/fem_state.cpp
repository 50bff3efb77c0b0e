#include "sinew/fem/fem_state.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/fem/fem_body_model.hpp"

namespace sinew::fem {

FemState::FemState(const FemBodyModel& model_in, int histories)
    : model(model_in),
      positions(model.mesh().nodes),
      velocities(model.start_velocities()),
      history(static_cast<std::size_t>(histories), Points::Zero(positions.rows(), 3)),
      element_history(model.elements().solids()),
      base(histories),
      start_positions(positions),
      external_forces(Points::Zero(positions.rows(), 3)),
      load_factors(model.loads().size(), 1.0) {}

void FemState::restart() {
  positions = model.mesh().nodes;
  velocities = model.start_velocities();
  for (Points& kept : history) kept.setZero();
  element_history.reset();
  base.restart();
}

std::size_t FemState::size() const {
  return (2 + history.size()) * static_cast<std::size_t>(positions.size()) +
         element_history.size() + base.state_size();
}

void FemState::save(std::span<double> to) const {
  double* next = std::copy_n(positions.data(), positions.size(), to.data());
  next = std::copy_n(velocities.data(), velocities.size(), next);
  for (const Points& kept : history) next = std::copy_n(kept.data(), kept.size(), next);
  element_history.save({next, element_history.size()});
  base.save_state({next + element_history.size(), base.state_size()});
}

void FemState::load(std::span<const double> from) {
  const double* next = from.data();
  const auto take = [&](Points& points) {
    std::copy_n(next, points.size(), points.data());
    next += points.size();
  };
  take(positions);
  take(velocities);
  for (Points& kept : history) take(kept);
  element_history.load({next, element_history.size()});
  base.load_state({next + element_history.size(), base.state_size()});
}

Vector3 FemState::combined(const mechanics::Combination& weights, NodeId node) const {
  Vector3 sum = weights.velocity * velocities.row(node).transpose() +
                weights.motion * (positions.row(node) - start_positions.row(node)).transpose();
  const bool kept = !history.empty() && (weights.first != 0.0 || weights.second != 0.0);
  if (!kept) return sum;
  sum += weights.first * history[0].row(node).transpose() +
         weights.second * history[1].row(node).transpose();
  return sum;
}

void FemState::combine(const mechanics::Combination& weights, VectorX& result) const {
  const auto nodes = model.elements().free_nodes();
  result.resize(3 * static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    result.segment<3>(3 * static_cast<Eigen::Index>(i)) = combined(weights, nodes[i]);
  }
}

double FemState::end_step(const mechanics::StepWeights& weights) {
  using Jump = mechanics::StepWeights::Jump;
  base.end_step(weights);
  if (!weights.dynamic()) {  // statics: no velocity and no history
    velocities.setZero();
    for (Points& kept : history) kept.setZero();
    return 0.0;
  }
  double worst = 0.0;
  const bool kept = !history.empty();
  for (Eigen::Index i = 0; i < positions.rows(); ++i) {
    const Vector3 d = (positions.row(i) - start_positions.row(i)).transpose();
    const Vector3 before = velocities.row(i).transpose();
    const Vector3 h0 = kept ? Vector3(history[0].row(i).transpose()) : Vector3::Zero();
    const Vector3 h1 = kept ? Vector3(history[1].row(i).transpose()) : Vector3::Zero();
    const auto sum = [&](const mechanics::Combination& c) -> Vector3 {
      return c.motion * d + c.velocity * before + c.first * h0 + c.second * h1;
    };
    const Vector3 velocity = sum(weights.velocity);
    velocities.row(i) = velocity.transpose();
    if (kept) {
      history[0].row(i) = sum(weights.first).transpose();
      history[1].row(i) = sum(weights.second).transpose();
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

std::size_t FemState::bytes() const {
  const std::size_t points = 4 + history.size();
  return sizeof(double) *
         (points * static_cast<std::size_t>(positions.size()) + element_history.size());
}

}  // namespace sinew::fem
