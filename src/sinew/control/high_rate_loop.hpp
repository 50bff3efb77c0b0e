/// @file
/// A thread at 500 Hz to 1 kHz beside a slow linearisation.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sinew/control/clock.hpp"
#include "sinew/control/device.hpp"
#include "sinew/control/high_rate_step.hpp"
#include "sinew/control/time_histogram.hpp"
#include "sinew/control/triple_buffer.hpp"

namespace sinew::control {

/// What a loop has done since it was made.
struct HighRateReport {
  std::int64_t periods = 0;    ///< outputs
  std::int64_t snapshots = 0;  ///< taken up; of several in one period the last
  /// Periods without an output in time: those whose output came after the next one was due, and
  /// those that were left out for that.
  std::int64_t missed = 0;
  std::int64_t limits_conflicts = 0, failures = 0;  ///< periods with them
  bool real_time = false;
  std::string scheduling;  ///< "SCHED_FIFO", or why not
};

/// Runs HighRateStep once a period. The model's thread publishes snapshots, others set the input
/// and read the output; the loop's thread waits for none of them (TripleBuffer). Every member
/// function may be called from any thread at any time.
class HighRateLoop {
 public:
  /// @param settings see there. @param device gives sensors, hands and driven efforts in place of
  ///   set_input(); null: none. Throws what check(settings) does.
  explicit HighRateLoop(HighRateSettings settings, std::shared_ptr<Device> device = nullptr);
  /// Stops.
  ~HighRateLoop();
  HighRateLoop(const HighRateLoop&) = delete;
  HighRateLoop& operator=(const HighRateLoop&) = delete;

  const HighRateSettings& settings() const { return step_.settings(); }
  /// Throws what check(snapshot) does. Its number is the loop's own.
  void publish(Snapshot snapshot);
  /// Throws Error(wrong-shape | not-finite): an infinite number; what is not there is NaN.
  void set_input(const HighRateInput& input);
  /// A copy of the latest.
  HighRateOutput output();
  HighRateReport report() const;
  const TimeHistogram& lateness() const { return lateness_; }  ///< of the beginning of periods
  const TimeHistogram& work() const { return work_; }          ///< of periods

  /// Begins a thread of its own on the machine's clock. Throws Error(bad-argument) where it runs.
  void start();
  /// Returns when the thread has ended; another start() goes on.
  void stop();
  bool running() const { return running_.load(std::memory_order_acquire); }
  /// The same in the calling thread, for so many periods or until stop(): what tests do with a
  /// clock of their own. Throws Error(bad-argument) where it runs.
  void run(Clock& clock, std::int64_t periods);

 private:
  void begin_run();
  void loop(Clock& clock, std::int64_t periods, const void* timeline);
  void period(double now);
  void read_input(double now);
  void note(double due, double begin, double end);

  HighRateStep step_;
  std::shared_ptr<Device> device_;

  std::mutex publishing_, setting_, reading_;  // among writers, and among readers, never the loop
  TripleBuffer<Snapshot> snapshots_;
  TripleBuffer<HighRateInput> inputs_;
  TripleBuffer<HighRateOutput> outputs_;
  std::uint64_t published_ = 0;

  // The loop's own.
  HighRateInput input_;
  double snapshot_seen_ = 0.0, input_seen_ = 0.0, last_begin_ = 0.0;  // s
  const void* timeline_ = nullptr;  // of these: the loop itself stands for the machine's
  std::atomic<std::int64_t> periods_{0}, taken_{0}, missed_{0}, conflicts_{0}, failures_{0};
  TimeHistogram lateness_, work_;

  std::atomic<bool> running_{false}, stop_{false};
  std::atomic<bool> real_time_{false};
  mutable std::mutex starting_;  // of thread_ and scheduling_
  std::thread thread_;
  std::string scheduling_ = "not started";
};

}  // namespace sinew::control
