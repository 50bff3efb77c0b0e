/// @file
/// The clock that a step's stages are timed by.
#pragma once

#include <chrono>

#include "sinew/sim/stages.hpp"

namespace sinew::sim {

/// Adds the time since the last mark to a stage.
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
  /// Since the last start.
  const StageTimes& times() const { return times_; }

 private:
  using Clock = std::chrono::steady_clock;
  StageTimes times_;
  Clock::time_point begin_, last_;
};

}  // namespace sinew::sim
