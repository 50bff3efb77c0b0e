/// @file
/// Memory of a thread for what is of no use when a function returns.
#pragma once

#include <cstddef>

namespace sinew::linalg {

/// A lease of the calling thread's memory: all simulations that step on one thread work in the same
/// place, instead of keeping a place of their own each. The memory grows to the largest lease and
/// is given back when the thread ends. One lease at a time on a thread; other threads may work in
/// it while it lasts. What stands in it at first is undefined.
class ThreadScratch {
 public:
  /// @param count doubles that take() may give, with 7 more for each call. Throws Error(internal)
  /// where this thread has a lease.
  explicit ThreadScratch(std::size_t count);
  ~ThreadScratch();
  ThreadScratch(const ThreadScratch&) = delete;
  ThreadScratch& operator=(const ThreadScratch&) = delete;

  /// The next `count` doubles, from a cache-line bound on; null for none.
  double* take(std::size_t count);

 private:
  std::size_t used_ = 0;
};

}  // namespace sinew::linalg
