/// @file
/// Clock that times the stages of a step.
#pragma once

#include <chrono>

#include "sinew/world/stages.hpp"

namespace sinew::world {

/// Accumulates the time of each stage: mark() adds the time since the last mark.
class StageClock {
 public:
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
  /// Times since the last start().
  const StageTimes& times() const { return times_; }

 private:
  using Clock = std::chrono::steady_clock;
  StageTimes times_;
  Clock::time_point begin_, last_;
};

}  // namespace sinew::world
