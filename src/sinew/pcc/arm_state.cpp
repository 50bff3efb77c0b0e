#include "sinew/pcc/arm_state.hpp"

#include <algorithm>

namespace sinew::pcc {

ArmState::ArmState(Eigen::Index coordinates, std::size_t rows, std::size_t entries, int histories)
    : q(VectorX::Zero(coordinates)),
      rate(q),
      history(static_cast<std::size_t>(histories), q),
      effort(VectorX::Zero(static_cast<Eigen::Index>(rows))),
      directions(entries, Vector3::Zero()),
      start(q) {}

void ArmState::restart() {
  q.setZero();
  rate.setZero();
  effort.setZero();
  std::ranges::fill(directions, Vector3::Zero());
  for (VectorX& kept : history) kept.setZero();
}

std::size_t ArmState::size() const {
  return (2 + history.size()) * static_cast<std::size_t>(q.size()) +
         static_cast<std::size_t>(effort.size()) + 3 * directions.size();
}

void ArmState::save(std::span<double> to) const {
  double* next = std::copy_n(q.data(), q.size(), to.data());
  next = std::copy_n(rate.data(), rate.size(), next);
  for (const VectorX& kept : history) next = std::copy_n(kept.data(), kept.size(), next);
  next = std::copy_n(effort.data(), effort.size(), next);
  for (const Vector3& direction : directions) next = std::copy_n(direction.data(), 3, next);
}

void ArmState::load(std::span<const double> from) {
  const double* next = from.data();
  const auto take = [&](double* to, Eigen::Index count) {
    std::copy_n(next, count, to);
    next += count;
  };
  take(q.data(), q.size());
  take(rate.data(), rate.size());
  for (VectorX& kept : history) take(kept.data(), kept.size());
  take(effort.data(), effort.size());
  for (Vector3& direction : directions) take(direction.data(), 3);
}

void ArmState::combine(const mechanics::Combination& weights, VectorX& result) const {
  result = weights.motion * (q - start) + weights.velocity * rate;
  if (history.empty()) return;
  result += weights.first * history[0] + weights.second * history[1];
}

}  // namespace sinew::pcc
