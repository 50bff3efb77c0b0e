/// @file
/// The latest value from one thread to another, without locks and without waiting.
#pragma once

#include <array>
#include <atomic>

namespace sinew::control {

/// Three slots: the writer has one, the reader another, and the third holds the latest value. Each
/// side exchanges its own for the third in one atomic operation, so that neither ever waits, and
/// the reader sees whole values, the latest one, each at most once. One writer and one reader.
template <typename Value>
class TripleBuffer {
 public:
  TripleBuffer() = default;
  /// All slots are copies of it, so that later assignments of the same size allocate nothing.
  explicit TripleBuffer(const Value& value) : slots_{value, value, value} {}

  /// The writer's slot, to be filled before publish().
  Value& slot() { return slots_[writer_]; }
  /// The writer's slot becomes the latest value.
  void publish() {
    const unsigned third = third_.exchange(writer_ | kFresh, std::memory_order_acq_rel);
    writer_ = third & kSlot;
  }

  /// The reader's slot; what it holds is the reader's own until the next take().
  Value& value() { return slots_[reader_]; }
  /// Takes the latest value into the reader's slot. False where there is none since the last call.
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

}  // namespace sinew::control
