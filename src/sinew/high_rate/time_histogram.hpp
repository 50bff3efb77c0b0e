/// @file
/// Histogram of times in microseconds.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace sinew::high_rate {

/// Histogram with bins of one microsecond up to a millisecond, and one bin for longer times. One
/// thread adds; other threads may read at the same time.
class TimeHistogram {
 public:
  static constexpr int kBins = 1000;

  /// Adds a time. @param seconds negative values count as 0.
  void add(double seconds);
  std::int64_t count() const;
  /// Counts of times within [k, k + 1) us, (kBins + 1,); the last one counts a millisecond and
  /// more.
  std::vector<std::int64_t> counts() const;
  /// Quantile, s: the upper end of the bin that contains it; the longest time if that is the last
  /// bin; 0 without any times. @param part 0..1: 0.5 for the median.
  double quantile(double part) const;
  double longest() const { return longest_.load(std::memory_order_relaxed); }  ///< s

 private:
  std::array<std::atomic<std::int64_t>, kBins + 1> counts_{};
  std::atomic<double> longest_{0.0};
};

}  // namespace sinew::high_rate
