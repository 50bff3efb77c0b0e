/// @file
/// A thread at 500 Hz to 1 kHz that works on snapshots of a slower simulation.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sinew/high_rate/clock.hpp"
#include "sinew/high_rate/device.hpp"
#include "sinew/high_rate/high_rate_step.hpp"
#include "sinew/high_rate/time_histogram.hpp"
#include "sinew/high_rate/triple_buffer.hpp"

namespace sinew::high_rate {

/// Counters of a loop since its construction.
struct HighRateReport {
  std::int64_t periods = 0;    ///< periods with an output
  std::int64_t snapshots = 0;  ///< snapshots used; of several in one period, only the last
  /// Periods without an output in time: those whose output came after the next period was due, and
  /// those that were skipped because of it.
  std::int64_t missed = 0;
  std::int64_t limits_conflicts = 0, failures = 0;  ///< periods in which they occurred
  bool real_time = false;
  std::string scheduling;  ///< "SCHED_FIFO", or why not
};

/// Runs HighRateStep once per period. The simulation's thread publishes snapshots; other threads
/// set the input and read the output. The loop's thread waits for none of them (TripleBuffer).
/// Every member function is thread-safe.
class HighRateLoop {
 public:
  /// @param settings of the loop. @param device provides sensors, hands and driven efforts in place
  ///   of set_input(); null: none. Throws what check(settings) throws.
  explicit HighRateLoop(HighRateSettings settings, std::shared_ptr<Device> device = nullptr);
  /// Stops.
  ~HighRateLoop();
  HighRateLoop(const HighRateLoop&) = delete;
  HighRateLoop& operator=(const HighRateLoop&) = delete;

  const HighRateSettings& settings() const { return step_.settings(); }
  /// Publishes a snapshot for the loop, which assigns its number. Throws what check(snapshot)
  /// throws.
  void publish(Snapshot snapshot);
  /// Sets the input; missing values are NaN. Throws Error: wrong-shape, not-finite (an infinite
  /// number).
  void set_input(const HighRateInput& input);
  /// A copy of the latest output.
  HighRateOutput output();
  HighRateReport report() const;
  const TimeHistogram& lateness() const { return lateness_; }  ///< delay of the start of periods
  const TimeHistogram& work() const { return work_; }          ///< computing time of periods

  /// Starts the loop in its own thread on the machine's clock. Throws Error: bad-argument if it is
  /// running.
  void start();
  /// Stops the loop and returns when its thread has ended. start() continues it.
  void stop();
  bool running() const { return running_.load(std::memory_order_acquire); }
  /// Runs the loop in the calling thread, for this many periods or until stop(); for tests with
  /// their own clock. Throws Error: bad-argument if it is running.
  void run(Clock& clock, std::int64_t periods);

 private:
  void begin_run();
  void loop(Clock& clock, std::int64_t periods, const void* timeline);
  void period(double now);
  void read_input(double now);
  void note(double due, double begin, double end);

  HighRateStep step_;
  std::shared_ptr<Device> device_;

  std::mutex publishing_, setting_, reading_;  // between writers, and between readers, not the loop
  TripleBuffer<Snapshot> snapshots_;
  TripleBuffer<HighRateInput> inputs_;
  TripleBuffer<HighRateOutput> outputs_;
  std::uint64_t published_ = 0;

  // Used by the loop's thread only.
  HighRateInput input_;
  double snapshot_seen_ = 0.0, input_seen_ = 0.0, last_begin_ = 0.0;  // s
  const void* timeline_ = nullptr;  // clock of these times; `this` stands for the machine's clock
  std::atomic<std::int64_t> periods_{0}, taken_{0}, missed_{0}, conflicts_{0}, failures_{0};
  TimeHistogram lateness_, work_;

  std::atomic<bool> running_{false}, stop_{false};
  std::atomic<bool> real_time_{false};
  mutable std::mutex starting_;  // guards thread_ and scheduling_
  std::thread thread_;
  std::string scheduling_ = "not started";
};

}  // namespace sinew::high_rate
