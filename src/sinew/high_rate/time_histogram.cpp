#include "sinew/high_rate/time_histogram.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/core/whole.hpp"

namespace sinew::high_rate {

void TimeHistogram::add(double seconds) {
  std::atomic<std::int64_t>& bin = counts_[whole<std::size_t>(seconds * 1e6, 0, kBins)];
  bin.store(bin.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (seconds > longest()) longest_.store(seconds, std::memory_order_relaxed);
}

std::vector<std::int64_t> TimeHistogram::counts() const {
  std::vector<std::int64_t> result;
  result.reserve(counts_.size());
  for (const auto& bin : counts_) result.push_back(bin.load(std::memory_order_relaxed));
  return result;
}

std::int64_t TimeHistogram::count() const {
  std::int64_t sum = 0;
  for (const auto& bin : counts_) sum += bin.load(std::memory_order_relaxed);
  return sum;
}

double TimeHistogram::quantile(double part) const {
  const std::vector<std::int64_t> all = counts();
  std::int64_t total = 0, below = 0;
  for (const std::int64_t bin : all) total += bin;
  if (total == 0) return 0.0;
  for (std::size_t k = 0; k + 1 < all.size(); ++k) {
    below += all[k];
    if (static_cast<double>(below) >= part * static_cast<double>(total)) {
      return 1e-6 * static_cast<double>(k + 1);
    }
  }
  return longest();
}

}  // namespace sinew::high_rate
