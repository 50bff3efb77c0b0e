/// @file
/// Progress reports of a step to its watcher.
#pragma once

#include <chrono>
#include <utility>

#include "sinew/core/poll.hpp"
#include "sinew/run/step_progress.hpp"

namespace sinew::run {

/// Tracks the progress of a step and reports it to the watcher. Solvers within the step call
/// poll().
class StepWatch {
 public:
  StepWatch() = default;
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;

  /// @param watcher the callback; empty: no reports.
  void set_watcher(StepWatcher watcher) { watcher_ = std::move(watcher); }

  /// Begins a step or another search.
  void begin() {
    progress_ = {};
    if (watcher_) begin_ = Clock::now();
  }
  void enter(SearchStage stage) { progress_.stage = stage; }
  /// Counts a Newton iteration, and reports. @param residual relative residual after it.
  void count(double residual) {
    ++progress_.iterations;
    progress_.relative_residual = residual;
    tell();
  }
  /// Number of iterations since begin().
  int iterations() const { return progress_.iterations; }
  /// A function that reports without counting.
  const Poll& poll() const { return poll_; }

 private:
  using Clock = std::chrono::steady_clock;

  void tell() {
    if (!watcher_) return;
    progress_.seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    watcher_(progress_);
  }

  StepWatcher watcher_;
  StepProgress progress_;
  Clock::time_point begin_;
  const Poll poll_ = [this] { tell(); };
};

}  // namespace sinew::run
