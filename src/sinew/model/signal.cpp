#include "sinew/model/signal.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew::model {

namespace {

constexpr double kNanosecond = 1e-9;

void require_finite(std::initializer_list<double> values, const char* what) {
  for (const double value : values) {
    if (!std::isfinite(value)) {
      throw Error(ErrorKind::not_finite, {}, fmt::format("{} holds {}", what, value),
                  "every number of a signal must be finite");
    }
  }
}

}  // namespace

Signal Signal::constant(double value) {
  require_finite({value}, "the command");
  return Signal(Constant{value});
}

Signal Signal::ramp(const Ramp& ramp) {
  require_finite({ramp.from, ramp.to, ramp.start, ramp.duration}, "the ramp");
  if (ramp.start < 0.0) {
    throw Error(ErrorKind::bad_signal, {}, fmt::format("the ramp starts at {} s", ramp.start),
                "start at 0 s or later");
  }
  if (ramp.duration <= 0.0) {
    throw Error(ErrorKind::bad_signal, {}, fmt::format("the ramp lasts {} s", ramp.duration),
                "give a duration above 0 s, or use steps for a jump");
  }
  return Signal(ramp);
}

Signal Signal::sine(const Sine& sine) {
  require_finite({sine.mean, sine.amplitude, sine.period, sine.phase}, "the sine");
  if (sine.period <= 0.0) {
    throw Error(ErrorKind::bad_signal, {}, fmt::format("the sine's period is {} s", sine.period),
                "give a period above 0 s");
  }
  return Signal(sine);
}

Signal Signal::table(Table table) {
  if (table.times.empty()) {
    throw Error(ErrorKind::bad_signal, {}, "the signal has no values", "give at least one");
  }
  for (std::size_t i = 0; i < table.times.size(); ++i) {
    require_finite({table.times[i], table.values[i]}, "the signal");
    if (i > 0 && table.times[i] <= table.times[i - 1]) {
      throw Error(ErrorKind::non_monotonic_time, {},
                  fmt::format("time {} s (value {}) follows {} s", table.times[i], i + 1,
                              table.times[i - 1]),
                  "times must increase");
    }
  }
  return Signal(std::move(table));
}

Signal Signal::steps(const std::vector<std::pair<double, double>>& steps) {
  Table result;
  for (const auto& [time, value] : steps) {
    result.times.push_back(time);
    result.values.push_back(value);
  }
  if (!steps.empty() && std::isfinite(steps.front().first) && steps.front().first != 0.0) {
    throw Error(ErrorKind::bad_signal, {},
                fmt::format("the steps begin at {} s", steps.front().first),
                "begin with a step at 0 s, which says what holds until then");
  }
  return table(std::move(result));
}

Signal Signal::sampled(std::vector<double> times, std::vector<double> values) {
  if (times.size() != values.size()) {
    throw Error(ErrorKind::wrong_length, {},
                fmt::format("{} times but {} values", times.size(), values.size()),
                "give one value for each time");
  }
  if (!times.empty() && times.front() < 0.0) {
    throw Error(ErrorKind::bad_signal, {}, fmt::format("the signal starts at {} s", times.front()),
                "time counts from 0 s, the start of the run");
  }
  return table({std::move(times), std::move(values), true});
}

double Signal::Table::value(double time) const {
  const double reached = interpolate ? time : time + kNanosecond;
  const auto after = std::upper_bound(times.begin(), times.end(), reached);
  if (after == times.begin()) return values.front();
  const auto last = static_cast<std::size_t>(after - times.begin()) - 1;
  if (!interpolate || after == times.end()) return values[last];
  const double share = (time - times[last]) / (times[last + 1] - times[last]);
  return std::lerp(values[last], values[last + 1], share);
}

double Signal::value(double time) const {
  if (const auto* constant = std::get_if<Constant>(&form_)) return constant->value;
  if (const auto* ramp = std::get_if<Ramp>(&form_)) {
    const double share = std::clamp((time - ramp->start) / ramp->duration, 0.0, 1.0);
    return std::lerp(ramp->from, ramp->to, share);
  }
  if (const auto* sine = std::get_if<Sine>(&form_)) {
    const double angle = 2.0 * std::numbers::pi * time / sine->period + sine->phase;
    return sine->mean + sine->amplitude * std::sin(angle);
  }
  return std::get<Table>(form_).value(time);
}

double Signal::lowest() const {
  if (const auto* constant = std::get_if<Constant>(&form_)) return constant->value;
  if (const auto* ramp = std::get_if<Ramp>(&form_)) return std::min(ramp->from, ramp->to);
  if (const auto* sine = std::get_if<Sine>(&form_)) return sine->mean - std::abs(sine->amplitude);
  return std::ranges::min(std::get<Table>(form_).values);
}

// Slope of the segment that contains a time.
double Signal::Table::slope(double time) const {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (!interpolate || after == times.begin() || after == times.end()) return 0.0;
  const auto last = static_cast<std::size_t>(after - times.begin()) - 1;
  return (values[last + 1] - values[last]) / (times[last + 1] - times[last]);
}

double Signal::rate(double time, Side side) const {
  const double piece = side == Side::after ? time + kNanosecond : time - kNanosecond;
  if (const auto* ramp = std::get_if<Ramp>(&form_)) {
    const bool rises = piece >= ramp->start && piece < ramp->start + ramp->duration;
    return rises ? (ramp->to - ramp->from) / ramp->duration : 0.0;
  }
  if (const auto* sine = std::get_if<Sine>(&form_)) {
    const double pace = 2.0 * std::numbers::pi / sine->period;
    return sine->amplitude * pace * std::cos(pace * time + sine->phase);
  }
  if (const auto* table = std::get_if<Table>(&form_)) return table->slope(piece);
  return 0.0;
}

double Signal::next_corner(double time) const {
  const double after = time + kNanosecond;
  if (const auto* ramp = std::get_if<Ramp>(&form_)) {
    for (const double corner : {ramp->start, ramp->start + ramp->duration}) {
      if (corner > after) return corner;
    }
  }
  if (const auto* table = std::get_if<Table>(&form_)) {
    const auto corner = std::upper_bound(table->times.begin(), table->times.end(), after);
    if (corner != table->times.end()) return *corner;
  }
  return kInfinity;
}

bool Signal::jumps() const {
  const auto* table = std::get_if<Table>(&form_);
  if (table == nullptr || table->interpolate) return false;
  return std::ranges::any_of(table->values,
                             [&](double value) { return value != table->values.front(); });
}

void Signal::add_to(ValueHash& hash) const {
  hash.add(form_.index());
  if (const auto* constant = std::get_if<Constant>(&form_)) hash.add(constant->value);
  if (const auto* ramp = std::get_if<Ramp>(&form_)) {
    hash.add(ramp->from, ramp->to, ramp->start, ramp->duration);
  }
  if (const auto* sine = std::get_if<Sine>(&form_)) {
    hash.add(sine->mean, sine->amplitude, sine->period, sine->phase);
  }
  if (const auto* table = std::get_if<Table>(&form_)) {
    hash.add(table->interpolate, table->times, table->values);
  }
}

double Signal::end_time() const {
  if (const auto* ramp = std::get_if<Ramp>(&form_)) return ramp->start + ramp->duration;
  if (const auto* sine = std::get_if<Sine>(&form_)) return sine->period;
  if (const auto* table = std::get_if<Table>(&form_)) return table->times.back();
  return 0.0;
}

}  // namespace sinew::model
