/// @file
/// Measures the real-time factor.
#pragma once

#include <chrono>
#include <deque>
#include <limits>

namespace sinew::viewer {

/// The real-time factor, averaged over the last half second or, if that is longer, one step.
class RealTimeFactor {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void restart() { samples_.clear(); }

  /// Adds a sample. @param now clock time. @param simulated time, s.
  void add(Time now, double simulated) {
    samples_.push_back({now, simulated});
    while (samples_.size() > 2 && now - samples_[1].clock >= kWindow) samples_.pop_front();
  }

  /// Simulated seconds per second; NaN until there are enough samples.
  double value() const {
    if (samples_.empty()) return std::numeric_limits<double>::quiet_NaN();
    const Sample &first = samples_.front(), &last = samples_.back();
    const std::chrono::duration<double> since = last.clock - first.clock;
    if (since < kLeast) return std::numeric_limits<double>::quiet_NaN();
    return (last.simulated - first.simulated) / since.count();
  }

 private:
  struct Sample {
    Time clock;
    double simulated;
  };
  static constexpr std::chrono::milliseconds kWindow{500}, kLeast{200};

  std::deque<Sample> samples_;
};

}  // namespace sinew::viewer
