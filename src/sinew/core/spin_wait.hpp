/// @file
/// Short waits for another thread: spin first, then yield the core.
#pragma once

#include <thread>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace sinew {

/// Hints to the core that this is a spin loop (x86 `pause`, ARM `yield`).
inline void pause_core() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Backoff of a spin loop. The first `pauses` rounds only pause; later ones yield to the operating
/// system, so that a thread on the same core can run.
class SpinWait {
 public:
  /// @param pauses number of rounds that pause before the loop yields; 0 if there are more threads
  ///   than cores.
  explicit SpinWait(int pauses) : pauses_(pauses) {}

  /// Waits for one round.
  void once() {
    if (round_ < pauses_) {
      pause_core();
    } else {
      std::this_thread::yield();
    }
    ++round_;
  }
  /// Number of rounds so far.
  int rounds() const { return round_; }

 private:
  int pauses_;
  int round_ = 0;
};

}  // namespace sinew
