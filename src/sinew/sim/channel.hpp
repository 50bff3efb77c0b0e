/// @file
/// What becomes of a quantity on its way through a sensor: errors, samples, losses, delay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sinew/core/philox.hpp"

namespace sinew::sim {

/// A sample k of a true value x, taken at the time t_k, says
///   y = clamp(round((x + bias + w_k + noise n_k)/quantum) quantum, min, max),
///   w_k = w_{k-1} + drift sqrt(t_k - t_{k-1}) m_k,  w_0 = 0,
/// n_k and m_k standard normal, independent of each other, of other samples and components.
struct ChannelSettings {
  double noise = 0.0;    ///< standard deviation of white noise, in the value's unit, >= 0
  double bias = 0.0;     ///< in the value's unit
  double drift = 0.0;    ///< standard deviation that the random walk w gains in 1 s, >= 0
  double quantum = 0.0;  ///< step of what is said, in the value's unit; 0: none
  double rate = 0.0;     ///< samples per second, >= 0; 0: every value that is offered
  double delay = 0.0;    ///< s from taking a sample to its delivery, >= 0
  double dropout = 0.0;  ///< probability that a sample is lost, 0 to 1
  double min = -std::numeric_limits<double>::infinity();  ///< in the value's unit
  double max = std::numeric_limits<double>::infinity();
  /// s: a sample that is older says nothing any more, > 0.
  double timeout = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 0;
  std::uint64_t stream = 0;  ///< tells apart channels of one seed

  /// Of one sample about the true value, bias and drift aside: that of the noise, and quantum^2/12
  /// of rounding (Bennett, Bell Syst. Tech. J. 27, 1948).
  double standard_deviation() const;
};

/// Knows no physics: values are offered to it, and it says what a sensor would say of them.
///
/// Sample k draws its random numbers from block (k, c, 0, 0) of Philox(seed, stream), c its
/// component: of the words 0 and 1 its noise, of 2 and 3 the step of its drift; whether it is lost
/// from the first word of block (k, 2^64 - 1, 0, 0). They depend on nothing else.
///
/// Values may also come from a real sensor, by receive(): from then on nothing that is offered is
/// sampled.
class Channel {
 public:
  /// s: times that are equal but for rounding.
  static constexpr double kSameTime = 1e-9;

  /// @param settings see there. @param size numbers of a value. Throws Error(out-of-range).
  Channel(const ChannelSettings& settings, std::size_t size);

  const ChannelSettings& settings() const { return settings_; }
  std::size_t size() const { return size_; }

  /// Takes a sample where one is due (the k-th at k/rate or after), and delivers what is due
  /// (within a nanosecond). @param time s, not before the last. @param truth (size(),).
  void offer(double time, std::span<const double> truth);
  /// As if the value had been the same for long: what was on its way is forgotten, and a sample of
  /// it delivered at once, without a further step of the drift. A lost one is followed by another.
  /// @param time s. @param truth (size(),).
  void settle(double time, std::span<const double> truth);
  /// Delivers a sample of a real sensor at once. One with a NaN is missing. Throws Error:
  /// wrong-length, not-finite (infinite), non-monotonic-time. @param time s, when it was taken.
  /// @param value (size(),).
  void receive(double time, std::span<const double> value);
  /// Back to the start.
  void restart();

  /// (size(),) the sample delivered last; NaN before the first.
  std::span<const double> value() const { return value_; }
  /// s, when that was taken; NaN before the first.
  double time() const { return time_; }
  /// Whether it was delivered by the last offer() or settle(), or by receive() since or just before
  /// that.
  bool fresh() const { return fresh_; }
  bool has_value() const { return has_value_; }
  /// Whether there is a sample that is not older than the timeout. @param now s.
  bool valid(double now) const;
  /// Whether values come from a real sensor.
  bool received() const { return received_; }
  std::int64_t samples() const { return samples_; }  ///< that were taken, lost ones included
  std::int64_t missing() const { return missing_; }  ///< samples that were lost, or had a NaN

  /// Appends all that changes, finite numbers. Allocates nothing where `memory` has the room.
  void save(std::vector<double>& memory) const;
  /// Takes it from the front of `memory`, which it shortens. @return whether it had all numbers.
  bool load(std::span<const double>& memory);

 private:
  bool is_due(double time);
  bool take(double time, std::span<const double> truth);
  void deliver(double time, std::span<const double> value);

  ChannelSettings settings_;
  std::size_t size_;
  Philox random_;
  std::int64_t samples_ = 0, missing_ = 0;
  double period_ = -1.0;              // of the rate, the last in which a sample was taken
  double taken_ = 0.0;                // s, when the last sample was taken
  std::vector<double> walk_;          // (size,) w
  std::vector<double> sample_;        // (size,) the one in hand
  std::vector<double> on_their_way_;  // (k, 2 + size): s of delivery and taking, value
  bool has_value_ = false, fresh_ = false, received_ = false, just_received_ = false;
  double time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> value_;
};

}  // namespace sinew::sim
