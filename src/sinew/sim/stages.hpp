/// @file
/// The stages of a step and how long each took.
#pragma once

#include <array>
#include <cstddef>

namespace sinew::sim {

/// Every step is these stages, in this order.
enum class Stage {
  assembly,       ///< elements: forces and matrix
  rows,           ///< H and delta
  factorisation,  ///< A bordered by H: factor, W and the free motion
  law,            ///< efforts
  correction,     ///< motion, and the check that it is sound
};
inline constexpr std::size_t kStageCount = 5;
inline constexpr std::array<const char*, kStageCount> kStageNames = {
    "assembly", "rows", "factorisation", "law", "correction"};

/// Seconds spent in each stage of one step.
struct StageTimes {
  std::array<double, kStageCount> seconds{};
  double total = 0.0;

  double operator[](Stage stage) const { return seconds[static_cast<std::size_t>(stage)]; }
};

}  // namespace sinew::sim
