/// @file
/// What a controller remembers from one step to the next.
#pragma once

#include <cstddef>
#include <span>

namespace sinew::step {

/// Memory as numbers: part of the state of the simulation that the controller is attached to.
class WithMemory {
 public:
  virtual ~WithMemory() = default;
  /// How many numbers, always the same.
  virtual std::size_t memory_size() const { return 0; }
  /// Into and from (memory_size(),) numbers.
  virtual void save_memory(std::span<double>) const {}
  virtual void load_memory(std::span<const double>) {}
  /// Remembers nothing, as at the start.
  virtual void forget() {}
};

}  // namespace sinew::step
