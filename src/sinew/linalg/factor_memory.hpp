/// @file
/// Memory that the factorisations of one plan lend each other.
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "sinew/linalg/aligned_buffer.hpp"

namespace sinew::linalg {

/// Between the steps of a simulation its factor is of no use. Of many simulations only those that
/// are in a step hold one, and the next one works in the memory that was given back last, which may
/// still be in the cache. May be used by several threads.
class FactorMemory {
 public:
  /// @param doubles of a factor.
  explicit FactorMemory(std::size_t doubles);

  /// What stands in it is undefined. Allocates where none is free.
  AlignedBuffer take();
  /// Keeps as many as the machine has threads, and frees others.
  void give_back(AlignedBuffer buffer);

 private:
  std::size_t doubles_;
  std::mutex mutex_;
  std::vector<AlignedBuffer> free_;
};

}  // namespace sinew::linalg
