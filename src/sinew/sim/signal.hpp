/// @file
/// Commands over time: what an actuator is told to do at each moment. SI units.
#pragma once

#include <utility>
#include <variant>
#include <vector>

#include "sinew/core/named_hash.hpp"

namespace sinew::sim {

/// `from` until `start`, then straight to `to` within `duration`, then held.
struct Ramp {
  double from = 0.0;      ///< the signal's unit
  double to = 0.0;        ///< the signal's unit
  double start = 0.0;     ///< s, >= 0
  double duration = 0.0;  ///< s, > 0
};

/// mean + amplitude sin(2 pi t / period + phase).
struct Sine {
  double mean = 0.0;       ///< the signal's unit
  double amplitude = 0.0;  ///< the signal's unit
  double period = 1.0;     ///< s, > 0
  double phase = 0.0;      ///< rad
};

/// A value as a function of time. Immutable; reading it allocates nothing and is thread-safe.
class Signal {
 public:
  /// Zero for ever.
  Signal() : form_(Constant{0.0}) {}

  /// One value for ever. Throws Error(not-finite).
  static Signal constant(double value);
  /// Throws Error(not-finite) or Error(bad-signal) when start < 0 or duration <= 0.
  static Signal ramp(const Ramp& ramp);
  /// Throws Error(not-finite) or Error(bad-signal) when period <= 0.
  static Signal sine(const Sine& sine);
  /// Each value holds from its time (within a nanosecond, so that rounding of n h does not delay
  /// it by a step) until the next one's; the last one holds for ever.
  /// @param steps pairs (time in s, value). The first time is 0, so that no moment is undefined.
  /// Throws Error(bad-signal) for no steps or a first time other than 0, Error(non-monotonic-time)
  /// when times do not increase, Error(not-finite).
  static Signal steps(const std::vector<std::pair<double, double>>& steps);
  /// Straight lines between samples; the first value holds before, the last one after.
  /// @param times (n,) s, increasing, >= 0.
  /// @param values (n,) in the signal's unit.
  /// Throws as steps() does, and Error(wrong-length) when the two differ in length.
  static Signal sampled(std::vector<double> times, std::vector<double> values);

  /// The value at `time` (s).
  double value(double time) const;

  /// On which side of a corner.
  enum class Side { before, after };
  /// Its derivative, in the signal's unit per s; 0 where it jumps. @param time s; a corner within a
  /// nanosecond is there. @param side of that.
  double rate(double time, Side side) const;
  /// s: the next corner or jump, later than a nanosecond after `time` (s); infinity: there is none.
  double next_corner(double time) const;
  /// Whether the value ever jumps.
  bool jumps() const;

  /// When the signal has shown all it has (s): 0 for a constant, the end of a ramp, one period of a
  /// sine, the last time of steps and samples. A run without a duration lasts this long.
  double end_time() const;

  /// Adds its form and numbers: equal signals add the same.
  void add_to(ValueHash& hash) const;

  /// True when the value is the same at all times.
  bool is_constant() const { return std::holds_alternative<Constant>(form_); }

 private:
  struct Constant {
    double value;
  };
  struct Table {
    std::vector<double> times;
    std::vector<double> values;
    bool interpolate = false;
    double value(double time) const;
    double slope(double time) const;
  };
  using Form = std::variant<Constant, Ramp, Sine, Table>;

  explicit Signal(Form form) : form_(std::move(form)) {}
  static Signal table(Table table);

  Form form_;
};

}  // namespace sinew::sim
