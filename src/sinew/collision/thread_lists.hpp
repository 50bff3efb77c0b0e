/// @file
/// A list that several threads fill, in an order that does not depend on their number.
#pragma once

#include <span>
#include <vector>

#include "sinew/core/thread_pool.hpp"

namespace sinew::collision {

/// Collects the results of several threads. Each thread has a contiguous part of the work and its
/// own list; joined in the order of the threads, these are the list of a single thread. The memory
/// of the largest call is kept.
template <typename Entry>
class ThreadLists {
 public:
  /// @param pool must outlive this object.
  explicit ThreadLists(ThreadPool& pool)
      : pool_(pool), parts_(static_cast<std::size_t>(pool.size())) {}

  /// Calls work(begin, end, list) on parts of [0, count). Each call appends the results of its part
  /// in order. @param count,grain,work see ThreadPool::for_range().
  /// @return the joined list, valid until the next call.
  template <typename Work>
  std::span<const Entry> collect(int count, int grain, const Work& work) {
    for (auto& part : parts_) part.clear();
    pool_.for_range(count, grain, [&](int begin, int end, int thread) {
      work(begin, end, parts_[static_cast<std::size_t>(thread)]);
    });
    all_.clear();
    for (const auto& part : parts_) all_.insert(all_.end(), part.begin(), part.end());
    return all_;
  }

 private:
  ThreadPool& pool_;
  std::vector<std::vector<Entry>> parts_;
  std::vector<Entry> all_;
};

}  // namespace sinew::collision
