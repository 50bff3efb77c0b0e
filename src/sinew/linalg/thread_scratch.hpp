/// @file
/// Scratch memory of a thread, for data that is not needed after a function returns.
#pragma once

#include <cstddef>

namespace sinew::linalg {

/// A lease of the scratch memory of the calling thread. All simulations that step on one thread
/// share this memory. It grows to the largest lease and is freed when the thread ends. A thread can
/// have one lease at a time; other threads may use its memory while it lasts. The content is
/// initially undefined.
class ThreadScratch {
 public:
  /// @param count total number of doubles for take(), plus 7 for each call. Throws Error(internal)
  ///   if this thread already has a lease.
  explicit ThreadScratch(std::size_t count);
  ~ThreadScratch();
  ThreadScratch(const ThreadScratch&) = delete;
  ThreadScratch& operator=(const ThreadScratch&) = delete;

  /// Takes the next `count` doubles, aligned to a cache line; null if count is 0.
  double* take(std::size_t count);

 private:
  std::size_t used_ = 0;
};

}  // namespace sinew::linalg
