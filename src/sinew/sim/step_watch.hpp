/// @file
/// Tells whoever watches a step how far it is.
#pragma once

#include <chrono>
#include <utility>

#include "sinew/core/poll.hpp"
#include "sinew/sim/step_progress.hpp"

namespace sinew::sim {

/// Counts a step's iterations. Solvers below a step are handed poll().
class StepWatch {
 public:
  StepWatch() = default;
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;

  /// @param watcher empty: nobody watches.
  void set_watcher(StepWatcher watcher) { watcher_ = std::move(watcher); }

  /// A step, or another search.
  void begin() {
    progress_ = {};
    if (watcher_) begin_ = Clock::now();
  }
  void enter(SearchStage stage) { progress_.stage = stage; }
  /// An iteration of Newton's, and the relative residual that it left.
  void count(double residual) {
    ++progress_.iterations;
    progress_.relative_residual = residual;
    tell();
  }
  /// Since begin().
  int iterations() const { return progress_.iterations; }
  /// Tells, and counts nothing.
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

}  // namespace sinew::sim
