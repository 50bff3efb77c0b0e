/// @file
/// Memory of factors, shared by the factorisations of one plan.
#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "sinew/linalg/aligned_buffer.hpp"

namespace sinew::linalg {

/// Pool of buffers for factors. A simulation does not need its factor between steps, so only
/// simulations in a step hold a buffer. The next one gets the buffer that was returned last, which
/// may still be in the cache. Thread-safe.
class FactorMemory {
 public:
  /// @param doubles size of a factor.
  explicit FactorMemory(std::size_t doubles);

  /// Takes a buffer, whose content is undefined. Allocates if none is free.
  AlignedBuffer take();
  /// Returns a buffer. The pool keeps as many as the machine has threads, and frees others.
  void give_back(AlignedBuffer buffer);

 private:
  std::size_t doubles_;
  std::mutex mutex_;
  std::vector<AlignedBuffer> free_;
};

}  // namespace sinew::linalg
