/// @file
/// Waiting for another thread within microseconds: spins, then gives the core away.
#pragma once

#include <thread>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace sinew {

/// Tells the core that this is a spin loop (x86 `pause`).
inline void pause_core() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Counts the rounds of a spin loop: `pauses` of them only pause, later ones yield to the operating
/// system, so that a thread which shares its core with the one it waits for lets that one run.
class SpinWait {
 public:
  /// @param pauses rounds that pause before rounds yield; 0 where threads outnumber cores.
  explicit SpinWait(int pauses) : pauses_(pauses) {}

  /// One round.
  void once() {
    if (round_ < pauses_) {
      pause_core();
    } else {
      std::this_thread::yield();
    }
    ++round_;
  }
  /// Rounds so far.
  int rounds() const { return round_; }

 private:
  int pauses_;
  int round_ = 0;
};

}  // namespace sinew
