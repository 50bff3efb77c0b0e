/// @file
/// Passes the latest value from one thread to another, lock-free and wait-free.
#pragma once

#include <array>
#include <atomic>

namespace sinew::high_rate {

/// Buffer with three slots: the writer owns one, the reader another, and the third holds the latest
/// value. Each side exchanges its own slot with the third in one atomic operation. So neither ever
/// waits, and the reader sees complete values, always the latest one, each at most once. For one
/// writer and one reader.
template <typename Value>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  /// Copies `value` to all slots, so that later assignments of the same size allocate nothing.
  explicit TripleBuffer(const Value& value) : slots_{value, value, value} {}

  /// The writer's slot, to be filled before publish().
  Value& slot() { return slots_[writer_]; }
  /// Makes the writer's slot the latest value.
  void publish() {
    const unsigned third = third_.exchange(writer_ | kFresh, std::memory_order_acq_rel);
    writer_ = third & kSlot;
  }

  /// The reader's slot, whose value belongs to the reader until the next take().
  Value& value() { return slots_[reader_]; }
  /// Moves the latest value to the reader's slot. Returns false if there is none since the last
  /// call.
  bool take() {
    if ((third_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reader_ = third_.exchange(reader_, std::memory_order_acq_rel) & kSlot;
    return true;
  }

 private:
  static constexpr unsigned kSlot = 3, kFresh = 4;

  std::array<Value, 3> slots_{};
  unsigned writer_ = 0, reader_ = 1;
  std::atomic<unsigned> third_{2};
};

}  // namespace sinew::high_rate
