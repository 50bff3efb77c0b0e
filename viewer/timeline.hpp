/// @file
/// The last seconds of a run, to go back to and to go on from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "sinew/core/types.hpp"
#include "sinew/inverse/inverse_settings.hpp"
#include "sinew/sim/inputs.hpp"
#include "sinew/sim/state.hpp"

#include "frame.hpp"

namespace sinew::viewer {

/// What acts on a run beside its state. Moments between which nothing of it has changed share one.
struct Acting {
  sim::Inputs inputs;                                ///< without the hand's spring
  std::string controller;                            ///< its name; empty without one
  std::optional<inverse::InverseSettings> settings;  ///< of the controller, targets included
  std::map<std::string, Vector3> targets;            ///< those that the page has set
};

/// All that decides how a run goes on from here.
struct Moment {
  sim::State state;
  std::shared_ptr<const Acting> acting;
  double time = 0.0;  ///< s, simulated
};

/// Moments of a run, the oldest dropped when they span too long a time or take too much memory (see
/// limits.hpp). They are numbered from 0 since the start.
class Timeline {
 public:
  /// Whether the present is to be kept: there are thirty moments a simulated second.
  bool due(double time) const;
  /// Appends the present. Moments after the one that was gone back to are dropped, for the run has
  /// taken another way; so is one of the same step.
  void keep(Moment moment);
  /// The moment with a number, or the nearest that is kept; it is the one shown from now on. There
  /// must be one.
  const Moment& go_back(std::int64_t number);
  /// The run goes on from the moment that is shown.
  void go_on();
  void clear();

  bool empty() const { return moments_.empty(); }
  /// Whether a moment before the latest is shown.
  bool in_past() const { return shown_.has_value(); }
  std::size_t size() const { return moments_.size(); }
  std::size_t bytes() const { return bytes_; }  ///< of the states
  /// @param time now, s.
  TimelineFrame describe(double time) const;

 private:
  std::int64_t latest() const { return first_ + static_cast<std::int64_t>(size()) - 1; }
  void drop_latest();

  std::deque<Moment> moments_;
  std::int64_t first_ = 0;             ///< number of the oldest
  std::optional<std::int64_t> shown_;  ///< none: the present
  std::size_t bytes_ = 0;
};

}  // namespace sinew::viewer
