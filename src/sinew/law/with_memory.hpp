/// @file
/// Memory of a controller between steps.
#pragma once

#include <cstddef>
#include <span>

namespace sinew::law {

/// Base class of objects with memory, as numbers in the state of the simulation to which they are
/// attached.
class WithMemory {
 public:
  virtual ~WithMemory() = default;
  /// Number of values; constant.
  virtual std::size_t memory_size() const { return 0; }
  /// Copy the memory to and from (memory_size(),) numbers.
  virtual void save_memory(std::span<double>) const {}
  virtual void load_memory(std::span<const double>) {}
  /// Resets the memory to that at the start.
  virtual void forget() {}
};

}  // namespace sinew::law
