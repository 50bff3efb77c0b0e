/// @file
/// Signals: values of commands and load factors as functions of time. SI units.
#pragma once

#include <utility>
#include <variant>
#include <vector>

#include "sinew/core/named_hash.hpp"

namespace sinew::model {

/// `from` until `start`, then linear to `to` within `duration`, then constant.
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
  /// Zero at all times.
  Signal() : form_(Constant{0.0}) {}

  /// A constant. Throws Error(not-finite).
  static Signal constant(double value);
  /// Throws Error(not-finite) or Error(bad-signal) when start < 0 or duration <= 0.
  static Signal ramp(const Ramp& ramp);
  /// Throws Error(not-finite) or Error(bad-signal) when period <= 0.
  static Signal sine(const Sine& sine);
  /// A step function. Each value holds from its time until that of the next one; the last one holds
  /// for ever. Times are compared within a nanosecond, so rounding of n h does not delay a step.
  /// @param steps pairs (time in s, value). The first time is 0, which defines the signal at all
  ///   times.
  /// Throws Error(bad-signal) for no steps or a first time other than 0, Error(non-monotonic-time)
  /// if times do not increase, Error(not-finite).
  static Signal steps(const std::vector<std::pair<double, double>>& steps);
  /// A piecewise linear function; before the first sample and after the last one it is constant.
  /// @param times (n,) s, increasing, >= 0.
  /// @param values (n,) in the signal's unit.
  /// Throws as steps() does, and Error(wrong-length) if `times` and `values` differ in length.
  static Signal sampled(std::vector<double> times, std::vector<double> values);

  /// The value at `time` (s).
  double value(double time) const;

  /// Side of a corner at which a derivative is taken.
  enum class Side { before, after };
  /// The derivative, in the signal's unit per s; 0 at a jump. @param time s; a corner within a
  /// nanosecond counts as at `time`. @param side of that corner.
  double rate(double time, Side side) const;
  /// s: the next corner or jump more than a nanosecond after `time` (s); infinity if there is none.
  double next_corner(double time) const;
  /// The lowest value at any time.
  double lowest() const;
  /// Whether the value ever jumps.
  bool jumps() const;

  /// The time (s) after which nothing new happens: 0 for a constant, the end of a ramp, one period
  /// of a sine, the last time of steps and samples. It is the default duration of a run.
  double end_time() const;

  /// Adds its type and parameters to a hash: equal signals add the same.
  void add_to(ValueHash& hash) const;

  /// Whether the value is the same at all times.
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

}  // namespace sinew::model
