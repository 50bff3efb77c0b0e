#include <algorithm>

#include "sinew/linalg/block_schedule.hpp"
#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

/// Approximate speeds of one core, to divide the work: they affect times, but not results.
constexpr double kFlopsPerSecond = 40e9;
constexpr double kDiagonalFlopsPerSecond = 15e9;
constexpr double kSecondsPerUpdate = 0.15e-6;
constexpr double kSecondsPerDouble = 0.3e-9;
/// A subtree becomes one task if its work is below this fraction of the work per thread.
constexpr double kSubtreeShare = 0.1;
/// Unit of the rows of a part: a multiple of 3 (nodes) and of 8 (full vectors).
constexpr Index kRowUnit = 24;
constexpr Index kMinSharedRows = 48;

double panel_cost(const Panel& panel) {
  return panel.flops / kFlopsPerSecond +
         kSecondsPerUpdate * (1 + panel.update_end - panel.update_begin) +
         kSecondsPerDouble * 3.0 * panel.width * panel.leading;
}

class TaskBuilder {
 public:
  TaskBuilder(const BlockSymbolic& symbolic, int threads)
      : s_(symbolic),
        threads_(threads),
        finished_by_(at(s_.panel_count())),
        children_(at(s_.panel_count() + 1)) {
    for (Index p = 0; p < s_.panel_count(); ++p) {
      children_[at(s_.panels[at(p)].parent)].push_back(p);
    }
  }

  std::vector<BlockTask> build() {
    find_subtrees();
    for (Index p = 0; p < s_.panel_count(); ++p) {
      if (s_.panels[at(p)].split) add_split_panel(p);
      if (subtree_first_[at(p)] >= 0) add_panels(subtree_first_[at(p)], p);
    }
    for (Index g = 0; g + 1 < static_cast<Index>(s_.group_start.size()); ++g) add_border(g);
    return std::move(tasks_);
  }

 private:
  /// Computes subtree_first_[p], the first panel of the task that ends at p; -1 if p is inside a
  /// task or split.
  void find_subtrees() {
    const Index count = s_.panel_count();
    std::vector<double> work(at(count));
    std::vector<Index> first(at(count));
    std::vector<char> whole(at(count));  // no split panel in the subtree
    double total = 0;
    for (Index p = 0; p < count; ++p) {
      work[at(p)] = panel_cost(s_.panels[at(p)]);
      total += work[at(p)];
      first[at(p)] = p;
      whole[at(p)] = s_.panels[at(p)].split ? 0 : 1;
      for (const Index c : children_[at(p)]) {
        work[at(p)] += work[at(c)];
        first[at(p)] = std::min(first[at(p)], first[at(c)]);
        whole[at(p)] = whole[at(p)] && whole[at(c)];
      }
    }
    const double limit = kSubtreeShare * total / threads_;
    subtree_first_.assign(at(count), -1);
    for (Index p = count; p-- > 0;) {
      if (s_.panels[at(p)].split) continue;
      if (whole[at(p)] && work[at(p)] <= limit) {
        subtree_first_[at(p)] = first[at(p)];
        p = first[at(p)];
      } else {
        subtree_first_[at(p)] = p;
      }
    }
  }

  Index add(BlockTask::Kind kind, Index first, Index last, double cost) {
    tasks_.push_back({kind, first, last, 0, 0, cost, {}});
    return static_cast<Index>(tasks_.size()) - 1;
  }

  void need_panel(Index task, Index panel) {
    const std::vector<Index>& by = finished_by_[at(panel)];
    tasks_[at(task)].needs.insert(tasks_[at(task)].needs.end(), by.begin(), by.end());
  }
  void need_children(Index task, Index panel) {
    for (const Index child : children_[at(panel)]) need_panel(task, child);
  }

  void add_panels(Index first, Index last) {
    double cost = 0;
    for (Index p = first; p <= last; ++p) cost += panel_cost(s_.panels[at(p)]);
    const Index task = add(BlockTask::Kind::panels, first, last, cost);
    if (first == last) need_children(task, last);
    for (Index p = first; p <= last; ++p) finished_by_[at(p)] = {task};
  }

  void add_split_panel(Index p) {
    const Panel& panel = s_.panels[at(p)];
    const double own = 3.0 * panel.width;
    const Index under = panel.height - panel.below;
    const Index assembled =
        add(BlockTask::Kind::assemble, p, p, kSecondsPerDouble * own * panel.leading);
    const double factorised = own * own * own / 3 + own * own * under;
    const double per_update_row = (kSecondsPerUpdate * (panel.update_end - panel.update_begin) +
                                   (panel.flops - factorised) / kFlopsPerSecond) /
                                  (0.5 * own + under);
    const Index diagonal =
        add(BlockTask::Kind::diagonal, p, p,
            0.5 * own * per_update_row + own * own * own / 3 / kDiagonalFlopsPerSecond);
    tasks_[at(diagonal)].needs.push_back(assembled);
    need_children(diagonal, p);
    const Index share = (under / (2 * threads_) + kRowUnit - 1) / kRowUnit * kRowUnit;
    const Index step = std::max(share, kMinSharedRows);
    std::vector<Index> updates;
    for (Index row = panel.below; row < panel.height; row += step) {
      const Index end = std::min(row + step, panel.height);
      updates.push_back(add(BlockTask::Kind::update, p, p, per_update_row * (end - row)));
      tasks_.back().row_begin = row;
      tasks_.back().row_end = end;
      tasks_.back().needs.push_back(assembled);
      need_children(updates.back(), p);
    }
    for (const Index update : updates) {
      const double rows = tasks_[at(update)].row_end - tasks_[at(update)].row_begin;
      const Index solve = add(BlockTask::Kind::solve, p, p, own * own * rows / kFlopsPerSecond);
      tasks_[at(solve)].row_begin = tasks_[at(update)].row_begin;
      tasks_[at(solve)].row_end = tasks_[at(update)].row_end;
      tasks_[at(solve)].needs = {diagonal, update};
      finished_by_[at(p)].push_back(solve);
    }
  }

  void add_border(Index group) {
    const Index begin = s_.group_start[at(group)];
    const Index end = s_.group_start[at(group) + 1];
    const double cost = panel_cost(s_.border_panel()) * (end - begin) / s_.panel_count();
    const Index task = add(BlockTask::Kind::border, group, group, cost);
    for (Index p = begin; p < end; ++p) {
      if (s_.panels[at(p)].parent >= end) need_panel(task, p);
    }
  }

  const BlockSymbolic& s_;
  int threads_;
  std::vector<BlockTask> tasks_;
  std::vector<std::vector<Index>> finished_by_;
  std::vector<std::vector<Index>> children_;
  std::vector<Index> subtree_first_;
};

}  // namespace

std::vector<BlockTask> block_tasks(const BlockSymbolic& symbolic, int threads) {
  return TaskBuilder(symbolic, threads).build();
}

double estimated_time(const BlockSymbolic& symbolic) {
  double time = 0;
  for (const Panel& panel : symbolic.panels) time += panel_cost(panel);
  return time;
}

}  // namespace sinew::linalg
