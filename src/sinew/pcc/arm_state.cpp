#include "sinew/pcc/arm_state.hpp"

#include <algorithm>

namespace sinew::pcc {

ArmState::ArmState(Eigen::Index coordinates, const mechanics::OwnRows& own, int histories)
    : q(VectorX::Zero(coordinates)),
      rate(q),
      history(static_cast<std::size_t>(histories), q),
      memory(own),
      start(q) {}

void ArmState::restart() {
  q.setZero();
  rate.setZero();
  memory.restart();
  for (VectorX& kept : history) kept.setZero();
}

std::size_t ArmState::size() const {
  return (2 + history.size()) * static_cast<std::size_t>(q.size()) + memory.size();
}

void ArmState::save(std::span<double> to) const {
  double* next = std::copy_n(q.data(), q.size(), to.data());
  next = std::copy_n(rate.data(), rate.size(), next);
  for (const VectorX& kept : history) next = std::copy_n(kept.data(), kept.size(), next);
  memory.save(next);
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
  memory.load(next);
}

void ArmState::combine(const mechanics::Combination& weights, VectorX& result) const {
  result = weights.motion * (q - start) + weights.velocity * rate;
  if (history.empty()) return;
  result += weights.first * history[0] + weights.second * history[1];
}

}  // namespace sinew::pcc
