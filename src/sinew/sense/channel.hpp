/// @file
/// Model of a sensor's channel: errors, sampling, losses and delay.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "sinew/core/philox.hpp"

namespace sinew::sense {

/// Sample k of a true value x, taken at the time t_k, has the value
///   y = clamp(round((x + bias + w_k + noise n_k)/quantum) quantum, min, max),
///   w_k = w_{k-1} + drift sqrt(t_k - t_{k-1}) m_k,  w_0 = 0,
/// where n_k and m_k are standard normal, independent of each other and across samples and
/// components.
struct ChannelSettings {
  double noise = 0.0;    ///< standard deviation of white noise, in the value's unit, >= 0
  double bias = 0.0;     ///< in the value's unit
  double drift = 0.0;    ///< standard deviation that the random walk w gains in 1 s, >= 0
  double quantum = 0.0;  ///< resolution, in the value's unit; 0: no rounding
  double rate = 0.0;     ///< samples per second, >= 0; 0: every value that is offered
  double delay = 0.0;    ///< s from taking a sample to its delivery, >= 0
  double dropout = 0.0;  ///< probability that a sample is lost, 0 to 1
  double min = -std::numeric_limits<double>::infinity();  ///< in the value's unit
  double max = std::numeric_limits<double>::infinity();
  /// s, > 0: an older sample is no longer valid.
  double timeout = std::numeric_limits<double>::infinity();
  std::uint64_t seed = 0;
  std::uint64_t stream = 0;  ///< distinguishes channels with the same seed

  /// Standard deviation of a sample without bias and drift: noise and the rounding error, whose
  /// variance is quantum^2/12 (Bennett, Bell Syst. Tech. J. 27, 1948).
  double standard_deviation() const;
};

/// Converts the true values that are offered to it into samples of a sensor; it contains no
/// physics.
///
/// Sample k draws its random numbers from block (k, c, 0, 0) of Philox(seed, stream), where c is
/// the component: words 0 and 1 give the noise, words 2 and 3 the increment of the drift. The first
/// word of block (k, 2^64 - 1, 0, 0) decides whether the sample is lost. The random numbers depend
/// on nothing else.
///
/// receive() delivers values of a real sensor; from its first call on, offered values are not
/// sampled.
class Channel {
 public:
  /// s: times that differ by less are equal up to rounding.
  static constexpr double kSameTime = 1e-9;

  /// @param settings of the channel. @param size number of components. Throws Error(out-of-range).
  Channel(const ChannelSettings& settings, std::size_t size);

  const ChannelSettings& settings() const { return settings_; }
  std::size_t size() const { return size_; }

  /// Takes a sample if one is due (the k-th at k/rate or later) and delivers those that are due
  /// (within a nanosecond). @param time s, not before the last. @param truth (size(),).
  void offer(double time, std::span<const double> truth);
  /// Acts as if the value had been constant for long: discards undelivered samples, then takes a
  /// sample and delivers it at once, without a further increment of the drift. Repeats if the
  /// sample is lost.
  /// @param time s. @param truth (size(),).
  void settle(double time, std::span<const double> truth);
  /// Delivers a sample of a real sensor at once. A sample with a NaN counts as missing. Throws
  /// Error: wrong-length, not-finite (infinite values), non-monotonic-time. @param time s, when it
  /// was taken.
  /// @param value (size(),).
  void receive(double time, std::span<const double> value);
  /// Returns to the initial state.
  void restart();

  /// (size(),) the last delivered sample; NaN before the first.
  std::span<const double> value() const { return value_; }
  /// s, when that sample was taken; NaN before the first.
  double time() const { return time_; }
  /// Whether that sample was delivered by the last offer() or settle(), or by receive() just before
  /// or since that call.
  bool fresh() const { return fresh_; }
  bool has_value() const { return has_value_; }
  /// Whether there is a sample no older than the timeout. @param now s.
  bool valid(double now) const;
  /// Whether values come from a real sensor.
  bool received() const { return received_; }
  std::int64_t samples() const { return samples_; }  ///< samples taken, including lost ones
  std::int64_t missing() const { return missing_; }  ///< samples lost or with a NaN

  /// Appends its state as finite numbers. Allocates nothing if `memory` has the capacity.
  void save(std::vector<double>& memory) const;
  /// Reads its state from the front of `memory`, which is shortened. @return whether the state was
  /// complete.
  bool load(std::span<const double>& memory);

 private:
  bool is_due(double time);
  bool take(double time, std::span<const double> truth);
  void deliver(double time, std::span<const double> value);

  ChannelSettings settings_;
  std::size_t size_;
  Philox random_;
  std::int64_t samples_ = 0, missing_ = 0;
  double period_ = -1.0;              // index of the last sampling period with a sample
  double taken_ = 0.0;                // s, when the last sample was taken
  std::vector<double> walk_;          // (size,) w
  std::vector<double> sample_;        // (size,) the current sample
  std::vector<double> on_their_way_;  // (k, 2 + size): times of delivery and sampling, s; value
  bool has_value_ = false, fresh_ = false, received_ = false, just_received_ = false;
  double time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> value_;
};

}  // namespace sinew::sense
