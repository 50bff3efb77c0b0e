/// @file
/// The time that a loop keeps.
#pragma once

#include <string>

namespace sinew::control {

/// Told apart from the loop so that tests turn it by hand.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now() = 0;  ///< s, never falls
  /// Returns at that time or later; at once where it is past. @param time s.
  virtual void sleep_until(double time) = 0;
};

/// The machine's monotonic clock, by absolute sleeps, which do not drift.
class MonotonicClock : public Clock {
 public:
  double now() override;
  void sleep_until(double time) override;
};

/// Asks the operating system to run the calling thread before all ordinary ones (SCHED_FIFO), at a
/// priority above theirs and below the kernel's own threads.
/// @return empty where it does; else why not, and the remedy.
std::string request_real_time();

}  // namespace sinew::control
