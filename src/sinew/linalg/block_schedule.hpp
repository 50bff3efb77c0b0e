/// @file
/// Which thread does which part of a block factorisation, and when: a static list per thread, made
/// once. A part waits only for the parts that it needs, never for a barrier. Since the parts of one
/// panel are the same operations whoever does them, the result does not depend on the threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/linalg/block_numeric.hpp"

namespace sinew::linalg {

/// One part of the work.
struct BlockTask {
  enum class Kind : std::uint8_t {
    panels,    ///< panels first .. last from assembly to solved rows, none of them split
    assemble,  ///< a split panel's entries of A, H and b
    diagonal,  ///< its diagonal block: update and factorise
    update,    ///< some of its rows below: update
    solve,     ///< the same rows, once the diagonal block is there
    border,    ///< group `first` of the border's updates
  };
  Kind kind;
  std::int32_t first, last;
  std::int32_t row_begin, row_end;  ///< of update and solve
  double cost;                      ///< estimate (s)
  std::vector<std::int32_t> needs;  ///< tasks that come before, all with smaller numbers
};

/// The lists for a fixed number of threads; owns the signals between them.
class BlockSchedule {
 public:
  BlockSchedule(const BlockSymbolic& symbolic, int threads);

  /// Fills `numeric` from `input`. `pool` must have as many threads as the schedule was made for.
  void factorise(BlockNumeric& numeric, const BlockInput& input, ThreadPool& pool);

  std::size_t bytes() const;

 private:
  struct Step {
    std::int32_t task;
    std::int32_t wait_begin, wait_end;  ///< in waits_: tasks of other threads that come before
  };
  struct alignas(64) Signal {
    std::atomic<std::uint32_t> round{0};
  };

  void assign(int threads);
  void run_thread(BlockNumeric& numeric, const BlockInput& input, int thread);

  std::vector<BlockTask> tasks_;  ///< empty for one thread
  std::vector<std::vector<Step>> lists_;
  std::vector<std::int32_t> waits_;
  std::vector<Signal> done_;  ///< round in which a task was last finished
  std::uint32_t round_ = 0;
  int pauses_ = 0;
};

/// The task graph of one factorisation for a number of threads.
std::vector<BlockTask> block_tasks(const BlockSymbolic& symbolic, int threads);

/// Estimated time of one factorisation on one thread (s), within about a fifth on a server core of
/// 2022. Depends on the pattern alone, so that the same robot gets the same order everywhere.
double estimated_time(const BlockSymbolic& symbolic);

}  // namespace sinew::linalg
