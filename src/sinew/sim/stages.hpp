/// @file
/// The stages of a step and how long each took.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace sinew::sim {

/// Every step is these stages, in this order.
enum class Stage {
  assembly,       ///< elements: forces and matrix
  compliance,     ///< H and delta
  factorisation,  ///< A bordered by H: factor, W and the free motion
  law,            ///< efforts
  correction,     ///< motion, and the check that it is sound
};
inline constexpr std::size_t kStageCount = 5;
inline constexpr std::array<const char*, kStageCount> kStageNames = {
    "assembly", "compliance", "factorisation", "law", "correction"};

/// Seconds spent in each stage of one step.
struct StageTimes {
  std::array<double, kStageCount> seconds{};
  double total = 0.0;

  double operator[](Stage stage) const { return seconds[static_cast<std::size_t>(stage)]; }
};

/// Adds the time since the last mark to a stage.
class StageClock {
 public:
  explicit StageClock(StageTimes& times) : times_(times) {}
  void start() {
    times_ = {};
    begin_ = last_ = Clock::now();
  }
  void mark(Stage stage) {
    const auto now = Clock::now();
    times_.seconds[static_cast<std::size_t>(stage)] +=
        std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  void stop() { times_.total = std::chrono::duration<double>(Clock::now() - begin_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  StageTimes& times_;
  Clock::time_point begin_, last_;
};

}  // namespace sinew::sim
