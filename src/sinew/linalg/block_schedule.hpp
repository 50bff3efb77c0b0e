/// @file
/// Static schedule of a block factorisation: one list of tasks per thread, made once. A task waits
/// only for the tasks that it needs; there are no barriers. The operations on a panel are the same
/// on any thread, so the result does not depend on the number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sinew/core/thread_pool.hpp"
#include "sinew/linalg/block_numeric.hpp"

namespace sinew::linalg {

/// A task of the factorisation.
struct BlockTask {
  enum class Kind : std::uint8_t {
    panels,    ///< panels first .. last, from assembly to solved rows; none of them split
    assemble,  ///< a split panel: assembles the entries of A, H and b
    diagonal,  ///< a split panel: updates and factorises the diagonal block
    update,    ///< a split panel: updates some of the rows below
    solve,     ///< a split panel: solves for these rows, after `diagonal`
    border,    ///< group `first` of the border updates
  };
  Kind kind;
  std::int32_t first, last;
  std::int32_t row_begin, row_end;  ///< of update and solve
  double cost;                      ///< estimated time, s
  std::vector<std::int32_t> needs;  ///< tasks that must be done before, all with smaller numbers
};

/// The schedule for a fixed number of threads. It owns the signals between them.
class BlockSchedule {
 public:
  BlockSchedule(const BlockSymbolic& symbolic, int threads);

  /// Factorises `input` into `numeric`. `pool` must have the number of threads of the schedule.
  void factorise(BlockNumeric& numeric, const BlockInput& input, ThreadPool& pool);

  std::size_t bytes() const;

 private:
  struct Step {
    std::int32_t task;
    std::int32_t wait_begin, wait_end;  ///< in waits_: needed tasks of other threads
  };
  struct alignas(64) Signal {
    std::atomic<std::uint32_t> round{0};
  };

  void assign(int threads);
  void run_thread(BlockNumeric& numeric, const BlockInput& input, int thread);

  std::vector<BlockTask> tasks_;  ///< empty for one thread
  std::vector<std::vector<Step>> lists_;
  std::vector<std::int32_t> waits_;
  std::vector<Signal> done_;  ///< last round in which each task was finished
  std::uint32_t round_ = 0;
  int pauses_ = 0;
};

/// The task graph of one factorisation for a number of threads.
std::vector<BlockTask> block_tasks(const BlockSymbolic& symbolic, int threads);

/// Estimated time of one factorisation on one thread, s, within about 20 % on a server core of
/// 2022. It depends only on the pattern, so that the same robot gets the same order on every
/// machine.
double estimated_time(const BlockSymbolic& symbolic);

}  // namespace sinew::linalg
