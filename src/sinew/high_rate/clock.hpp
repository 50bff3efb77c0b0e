/// @file
/// The clock of a high-rate loop.
#pragma once

#include <string>

namespace sinew::high_rate {

/// Clock of a loop. An interface, so that tests can advance the time by hand.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now() = 0;  ///< s, never decreases
  /// Returns at this time or later; at once if it is past. @param time s.
  virtual void sleep_until(double time) = 0;
};

/// The machine's monotonic clock. Sleeps until absolute times, so it does not drift.
class MonotonicClock : public Clock {
 public:
  double now() override;
  void sleep_until(double time) override;
};

/// Asks the operating system to run the calling thread with real-time priority (SCHED_FIFO), above
/// all ordinary threads and below the kernel's own threads.
/// @return empty on success; otherwise the reason for the refusal and the remedy.
std::string request_real_time();

}  // namespace sinew::high_rate
