/// @file
/// Which thread does which part of a block factorisation, and when.
#pragma once

#include <cstddef>

#include "sinew/core/thread_pool.hpp"
#include "sinew/linalg/block_numeric.hpp"

namespace sinew::linalg {

class BlockSchedule {
 public:
  BlockSchedule(const BlockSymbolic& symbolic, int threads) {
    (void)symbolic;
    (void)threads;
  }
  void factorise(BlockNumeric& numeric, const BlockInput& input, ThreadPool& pool);
  std::size_t bytes() const { return 0; }
};

}  // namespace sinew::linalg
