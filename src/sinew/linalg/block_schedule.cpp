#include "sinew/linalg/block_schedule.hpp"

#include <algorithm>
#include <thread>

#include "sinew/core/spin_wait.hpp"
#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

/// Priority bonus, s, for a task on the thread that has its operands in its cache.
constexpr double kCacheBonus = 2e-6;
/// Pauses before a waiting thread yields: a few microseconds, the duration of a task.
constexpr int kPauses = 300;

void do_panel(BlockNumeric& numeric, int p, const BlockInput& input,
              BlockNumeric::Scratch& scratch) {
  const Panel& panel = numeric.symbolic().panels[at(p)];
  numeric.assemble(p, input);
  numeric.update(p, 0, panel.height, scratch);
  numeric.factorise(p, scratch);
  if (panel.split) numeric.solve_rows(p, panel.below, panel.height, scratch);
}

void do_task(BlockNumeric& numeric, const BlockTask& task, const BlockInput& input,
             BlockNumeric::Scratch& scratch) {
  switch (task.kind) {
    case BlockTask::Kind::panels:
      for (Index p = task.first; p <= task.last; ++p) do_panel(numeric, p, input, scratch);
      break;
    case BlockTask::Kind::assemble:
      numeric.assemble(task.first, input);
      break;
    case BlockTask::Kind::diagonal:
      numeric.update(task.first, 0, 3 * numeric.symbolic().panels[at(task.first)].width, scratch);
      numeric.factorise(task.first, scratch);
      break;
    case BlockTask::Kind::update:
      numeric.update(task.first, task.row_begin, task.row_end, scratch);
      break;
    case BlockTask::Kind::solve:
      numeric.solve_rows(task.first, task.row_begin, task.row_end, scratch);
      break;
    case BlockTask::Kind::border:
      numeric.update_border(task.first, scratch);
      break;
  }
}

/// Time from the start of each task to the end of the longest chain of tasks that need it.
std::vector<double> remaining_time(const std::vector<BlockTask>& tasks) {
  std::vector<double> remaining(tasks.size(), 0);
  for (std::size_t t = tasks.size(); t-- > 0;) {
    remaining[t] += tasks[t].cost;
    for (const Index need : tasks[t].needs) {
      remaining[at(need)] = std::max(remaining[at(need)], remaining[t]);
    }
  }
  return remaining;
}

/// Simulates the run with estimated times. A free thread takes the ready task with the longest
/// remaining chain.
class Simulation {
 public:
  Simulation(const std::vector<BlockTask>& tasks, int threads)
      : tasks_(tasks),
        remaining_(remaining_time(tasks)),
        missing_(tasks.size()),
        followers_(tasks.size()),
        ready_at_(tasks.size(), 0),
        free_at_(at(threads), 0),
        thread_of_(tasks.size(), -1) {
    for (std::size_t t = 0; t < tasks.size(); ++t) {
      missing_[t] = tasks[t].needs.size();
      for (const Index need : tasks[t].needs) followers_[at(need)].push_back(static_cast<Index>(t));
      if (tasks[t].needs.empty()) ready_.push_back(static_cast<Index>(t));
    }
  }

  /// Tasks of each thread in order.
  std::vector<std::vector<Index>> run() {
    std::vector<std::vector<Index>> lists(free_at_.size());
    for (std::size_t taken = 0; taken < tasks_.size(); ++taken) {
      const auto thread =
          static_cast<Index>(std::min_element(free_at_.begin(), free_at_.end()) - free_at_.begin());
      const Index task = choose(thread);
      lists[at(thread)].push_back(task);
      finish(task, thread);
    }
    return lists;
  }

  int thread_of(Index task) const { return thread_of_[at(task)]; }

 private:
  Index choose(Index thread) {
    double now = free_at_[at(thread)];
    double soonest = ready_at_[at(ready_.front())];
    for (const Index task : ready_) soonest = std::min(soonest, ready_at_[at(task)]);
    now = std::max(now, soonest);
    const auto score = [&](Index task) {
      if (ready_at_[at(task)] > now) return -1.0;
      const std::vector<Index>& needs = tasks_[at(task)].needs;
      const bool near = std::any_of(needs.begin(), needs.end(),
                                    [&](Index need) { return thread_of_[at(need)] == thread; });
      return remaining_[at(task)] + (near ? kCacheBonus : 0);
    };
    const auto best = std::max_element(ready_.begin(), ready_.end(), [&](Index a, Index b) {
      const double score_a = score(a);
      const double score_b = score(b);
      return score_a != score_b ? score_a < score_b : a > b;
    });
    const Index task = *best;
    ready_.erase(best);
    free_at_[at(thread)] = now;
    return task;
  }

  void finish(Index task, Index thread) {
    thread_of_[at(task)] = thread;
    free_at_[at(thread)] += tasks_[at(task)].cost;
    for (const Index next : followers_[at(task)]) {
      ready_at_[at(next)] = std::max(ready_at_[at(next)], free_at_[at(thread)]);
      if (--missing_[at(next)] == 0) ready_.push_back(next);
    }
  }

  const std::vector<BlockTask>& tasks_;
  std::vector<double> remaining_;
  std::vector<std::size_t> missing_;
  std::vector<std::vector<Index>> followers_;
  std::vector<double> ready_at_;
  std::vector<double> free_at_;
  std::vector<Index> thread_of_;
  std::vector<Index> ready_;
};

}  // namespace

BlockSchedule::BlockSchedule(const BlockSymbolic& symbolic, int threads) {
  if (threads == 1) return;
  tasks_ = block_tasks(symbolic, threads);
  done_ = std::vector<Signal>(tasks_.size());
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  pauses_ = threads <= cores ? kPauses : 0;
  assign(threads);
}

void BlockSchedule::assign(int threads) {
  Simulation simulation(tasks_, threads);
  const std::vector<std::vector<Index>> orders = simulation.run();
  for (int thread = 0; thread < threads; ++thread) {
    lists_.emplace_back();
    for (const Index task : orders[at(thread)]) {
      const auto begin = static_cast<Index>(waits_.size());
      for (const Index need : tasks_[at(task)].needs) {
        if (simulation.thread_of(need) != thread) waits_.push_back(need);
      }
      lists_.back().push_back({task, begin, static_cast<Index>(waits_.size())});
    }
  }
}

void BlockSchedule::factorise(BlockNumeric& numeric, const BlockInput& input, ThreadPool& pool) {
  const BlockSymbolic& s = numeric.symbolic();
  if (tasks_.empty()) {
    BlockNumeric::Scratch& scratch = numeric.scratch(0);
    for (Index g = 0; g + 1 < static_cast<Index>(s.group_start.size()); ++g) {
      for (Index p = s.group_start[at(g)]; p < s.group_start[at(g) + 1]; ++p) {
        do_panel(numeric, p, input, scratch);
      }
      numeric.update_border(g, scratch);
    }
  } else {
    ++round_;
    pool.run([&](int thread) {
      pool.add_parts(thread, static_cast<long>(lists_[at(thread)].size()));
      run_thread(numeric, input, thread);
    });
  }
  numeric.finish_border();
}

void BlockSchedule::run_thread(BlockNumeric& numeric, const BlockInput& input, int thread) {
  BlockNumeric::Scratch& scratch = numeric.scratch(thread);
  for (const Step& step : lists_[at(thread)]) {
    for (Index w = step.wait_begin; w < step.wait_end; ++w) {
      const std::atomic<std::uint32_t>& done = done_[at(waits_[at(w)])].round;
      for (SpinWait spin(pauses_); done.load(std::memory_order_acquire) != round_;) spin.once();
    }
    do_task(numeric, tasks_[at(step.task)], input, scratch);
    done_[at(step.task)].round.store(round_, std::memory_order_release);
  }
}

std::size_t BlockSchedule::bytes() const {
  std::size_t total = done_.size() * sizeof(Signal) + waits_.size() * sizeof(Index);
  for (const BlockTask& task : tasks_) total += sizeof task + task.needs.size() * sizeof(Index);
  for (const std::vector<Step>& list : lists_) total += list.size() * sizeof(Step);
  return total;
}

}  // namespace sinew::linalg
