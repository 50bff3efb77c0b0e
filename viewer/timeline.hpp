/// @file
/// The last seconds of a run, to which the user can go back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "sinew/control/target_controller.hpp"
#include "sinew/core/types.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/state.hpp"

#include "frame.hpp"

namespace sinew::viewer {

/// The inputs of a run besides its state. Moments between which these have not changed share one.
struct Acting {
  run::Inputs inputs;                                   ///< without the mouse spring
  std::string controller;                               ///< name; empty: none
  std::optional<control::ControllerSettings> settings;  ///< of the controller, including targets
  std::map<std::string, Vector3> targets;               ///< set by the page
};

/// Everything that determines how a run continues from one time.
struct Moment {
  run::State state;
  std::shared_ptr<const Acting> acting;
  double time = 0.0;  ///< s, simulated
};

/// The moments of a run, numbered from 0. The oldest are dropped if they span too long a time or
/// take too much memory (see limits.hpp).
class Timeline {
 public:
  /// Whether a moment at this time (s) is to be kept: there are 30 moments per simulated second.
  bool due(double time) const;
  /// Appends a moment. It drops moments after the shown one, since the run has taken another path,
  /// and a moment of the same step.
  void keep(Moment moment);
  /// Goes back to the moment with a number or the nearest one that is kept, which is shown from now
  /// on. The timeline must not be empty.
  const Moment& go_back(std::int64_t number);
  /// Continues the run from the shown moment; drops the moments after it.
  void go_on();
  void clear();

  bool empty() const { return moments_.empty(); }
  /// Whether the shown moment is earlier than the latest.
  bool in_past() const { return shown_.has_value(); }
  std::size_t size() const { return moments_.size(); }
  std::size_t bytes() const { return bytes_; }  ///< of the states
  /// The timeline as sent to the page. @param time current time, s.
  TimelineFrame describe(double time) const;

 private:
  std::int64_t latest() const { return first_ + static_cast<std::int64_t>(size()) - 1; }
  void drop_latest();

  std::deque<Moment> moments_;
  std::int64_t first_ = 0;             ///< number of the oldest moment
  std::optional<std::int64_t> shown_;  ///< none: the current state
  std::size_t bytes_ = 0;
};

}  // namespace sinew::viewer
