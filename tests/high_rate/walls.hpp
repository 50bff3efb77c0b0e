// A virtual wall as a snapshot, and a hand with a seeded motion.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sinew/core/random.hpp"
#include "sinew/high_rate/high_rate_step.hpp"
#include "sinew/high_rate/snapshot.hpp"

namespace sinew::testing {

inline constexpr double kWallStiffness = 1000.0;  // N/m

/// Settings with one hand that pushes on a wall, which occupies x > 0.
inline high_rate::HighRateSettings wall_settings() {
  high_rate::HighRateSettings settings;
  settings.hands = {{.min = 0.0}};
  settings.max_contacts = 0;
  return settings;
}

inline high_rate::Snapshot wall(double stiffness = kWallStiffness) {
  high_rate::Snapshot snapshot;
  snapshot.compliance = MatrixX::Constant(1, 1, 1.0 / stiffness);
  snapshot.free = snapshot.effort = VectorX::Zero(1);
  return snapshot;
}

/// A motion of eight sines about the surface of the wall, with seeded phases and frequencies up to
/// 6 Hz. Its largest displacement in a minute is 10 mm.
class SeededHand {
 public:
  explicit SeededHand(std::uint64_t seed) {
    Random random(seed);
    for (std::size_t k = 0; k < frequency_.size(); ++k) {
      frequency_[k] = k == 0 ? 6.0 : random.uniform(0.2, 6.0);
      phase_[k] = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
    double farthest = 0.0;
    for (int k = 0; k < 60000; ++k) farthest = std::max(farthest, std::abs(at(1e-3 * k)));
    scale_ *= 10e-3 / farthest;
  }
  /// Position, m. @param time s.
  double at(double time) const {
    double place = 0.0;
    for (std::size_t k = 0; k < frequency_.size(); ++k) {
      place += std::sin(2.0 * std::numbers::pi * frequency_[k] * time + phase_[k]);
    }
    return scale_ * place;
  }

 private:
  std::array<double, 8> frequency_{}, phase_{};
  double scale_ = 1.0;  // m
};

}  // namespace sinew::testing
