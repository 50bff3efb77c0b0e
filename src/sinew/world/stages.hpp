/// @file
/// The timed stages of a step.
#pragma once

#include <array>
#include <cstddef>

namespace sinew::world {

/// The stages of a step, in order.
enum class Stage {
  detection,      ///< search for points of contact; checks that nothing has passed
  assembly,       ///< forces and stiffness matrix of the elements
  rows,           ///< H and delta
  factorisation,  ///< factor of A bordered by H; W and the free motion
  law,            ///< solution of the laws for the efforts
  correction,     ///< application and check of the motion
};
inline constexpr std::size_t kStageCount = 6;
inline constexpr std::array<const char*, kStageCount> kStageNames = {
    "detection", "assembly", "rows", "factorisation", "law", "correction"};

/// Time spent in each stage of one step, s.
struct StageTimes {
  std::array<double, kStageCount> seconds{};
  double total = 0.0;

  double operator[](Stage stage) const { return seconds[static_cast<std::size_t>(stage)]; }
};

}  // namespace sinew::world
