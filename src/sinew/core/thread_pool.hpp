/// @file
/// A small persistent fork-join pool for the loops of a step (oneTBB is used for coarse work).
/// Between calls, workers spin briefly and then sleep, so that an idle simulation uses no processor
/// time.
#pragma once

#include <memory>
#include <type_traits>

namespace sinew {

/// A pool of size() threads, including the caller. One call runs at a time; the pool is not
/// re-entrant. Work is assigned to threads by number, never by race, so results do not depend on
/// timing.
class ThreadPool {
 public:
  /// @param threads total number of threads, including the caller, >= 1. Throws Error(out-of-range)
  ///   otherwise.
  explicit ThreadPool(int threads = 1);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int size() const;

  /// Number of parts of work that a thread has done so far, to show that all threads take part.
  /// for_range() counts them, and callers of add_parts(); each thread counts its own.
  long parts_done(int thread) const;
  void add_parts(int thread, long count);

  /// Calls work(thread) once on every thread, thread = 0 .. size()-1 (0 is the caller), and returns
  /// when all are done. Does not allocate. `work` must not throw.
  template <typename Work>
  void run(Work&& work) {
    using Callable = std::remove_reference_t<Work>;
    run_raw([](void* context, int thread) { (*static_cast<Callable*>(context))(thread); },
            const_cast<void*>(static_cast<const void*>(&work)));
  }

  /// Calls work(begin, end, thread) on contiguous parts of [0, count), one part per thread. Sizes
  /// are multiples of `grain`, except for the last part. If count <= grain, the caller does it all.
  template <typename Work>
  void for_range(int count, int grain, Work&& work) {
    const int parts = size();
    if (parts == 1 || count <= grain) {
      if (count > 0) {
        add_parts(0, 1);
        work(0, count, 0);
      }
      return;
    }
    const int grains = (count + grain - 1) / grain;
    run([&](int thread) {
      const int begin = static_cast<int>(static_cast<long>(grains) * thread / parts) * grain;
      const int end = static_cast<int>(static_cast<long>(grains) * (thread + 1) / parts) * grain;
      if (begin < end && begin < count) {
        add_parts(thread, 1);
        work(begin, end < count ? end : count, thread);
      }
    });
  }

 private:
  using RawWork = void (*)(void* context, int thread);
  void run_raw(RawWork work, void* context);

  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace sinew
