#include "sinew/linalg/block_symbolic.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

/// Zero rows after a panel: one less than the widest vector of any instruction set in use.
constexpr Index kTail = 7;
/// Minimum number of zero rows between the diagonal block and the rows below of a split panel; the
/// first row below is a multiple of it.
constexpr Index kGap = 8;
/// Minimum work, flops, for dividing the rows of a panel between threads.
constexpr double kSplitFlops = 4e5;
constexpr Index kSplitRows = 96;
constexpr int kBorderGroups = 8;

std::vector<std::vector<Index>> border_nodes_of(int nodes, const BorderPattern& border) {
  std::vector<std::vector<Index>> result(at(nodes));
  for (Index k = 0; k < border.rows(); ++k) {
    for (Index e = border.row_start[at(k)]; e < border.row_start[at(k) + 1]; ++e) {
      std::vector<Index>& groups = result[at(border.node[at(e)])];
      if (groups.empty() || groups.back() != k / 3) groups.push_back(k / 3);
    }
  }
  for (std::vector<Index>& groups : result) {  // b touches every node
    const Index last = border.rows() / 3;
    if (groups.empty() || groups.back() != last) groups.push_back(last);
  }
  return result;
}

/// A multiple of a cache line, so that windows of 8 rows are aligned, but not of 8 lines, since
/// columns would then map to the same few cache sets.
Index leading_dimension(Index height) {
  const Index leading = (height + kTail + 7) / 8 * 8;
  return leading % 64 == 0 ? leading + 8 : leading;
}

/// Builds the lists panel by panel.
class PanelBuilder {
 public:
  PanelBuilder(BlockSymbolic& result, const SupernodePartition& partition)
      : s_(result),
        partition_(partition),
        place_(at(result.nodes + result.border_nodes), -1),
        panel_of_(place_.size(), partition.count()) {
    for (Index p = 0; p < partition_.count(); ++p) {
      std::fill(panel_of_.begin() + partition_.start[at(p)],
                panel_of_.begin() + partition_.start[at(p) + 1], p);
    }
  }

  /// Makes the panels in order, with the ranges of rows that update each, by descendant.
  void lay_out() {
    std::vector<std::vector<Range>> ranges(at(partition_.count() + 1));
    for (Index d = 0; d < partition_.count(); ++d) find_ranges(d, ranges);
    for (Index p = 0; p < partition_.count(); ++p) add_panel(p, flops_of(p, ranges[at(p)]));
    add_border_panel(flops_of(partition_.count(), ranges.back()));
    for (Index p = 0; p <= partition_.count(); ++p) add_updates(p, ranges[at(p)]);
  }

  void place_blocks(const BlockPattern& pattern) {
    // The row of a block in its panel is found panel by panel, so blocks are sorted by panel first.
    std::vector<std::vector<Block>> blocks(at(partition_.count()));
    for (Index j = 0; j < pattern.nodes; ++j) {
      for (Index b = pattern.column_start[at(j)]; b < pattern.column_start[at(j) + 1]; ++b) {
        const Index row = s_.position[at(pattern.row[at(b)])];
        const Index column = s_.position[at(j)];
        const auto [low, high] = std::minmax(row, column);
        blocks[at(panel_of_[at(low)])].push_back({b, high, low, row < column});
      }
    }
    for (Index p = 0; p < partition_.count(); ++p) add_blocks(s_.panels[at(p)], blocks[at(p)]);
  }

  void place_border(const BorderPattern& border) {
    std::vector<std::vector<Block>> entries(at(partition_.count()));
    for (Index k = 0; k < border.rows(); ++k) {
      for (Index e = border.row_start[at(k)]; e < border.row_start[at(k) + 1]; ++e) {
        const Index column = s_.position[at(border.node[at(e)])];
        entries[at(panel_of_[at(column)])].push_back({e, k, column, false});
      }
    }
    for (Index p = 0; p < partition_.count(); ++p) {
      Panel& panel = s_.panels[at(p)];
      place_rows(panel);
      panel.border_begin = static_cast<Index>(s_.border.size());
      for (const Block& entry : entries[at(p)]) {
        const Index row = place_[at(s_.nodes + entry.row / 3)] + entry.row % 3;
        s_.border.push_back(
            {3 * entry.number, 3 * (entry.column - panel.first) * panel.leading + row});
      }
      panel.border_end = static_cast<Index>(s_.border.size());
      panel.right_row = place_[at(s_.nodes + s_.border_rows / 3)] + s_.border_rows % 3;
    }
  }

 private:
  struct Range {
    Index descendant, begin, end;  // in the list of rows of the descendant
  };
  struct Block {
    Index number, row, column;
    bool transposed;
  };

  void find_ranges(Index d, std::vector<std::vector<Range>>& ranges) const {
    const std::vector<Index>& rows = partition_.rows[at(d)];
    const auto count = static_cast<Index>(rows.size());
    for (Index i = 0; i < count;) {
      const Index target = panel_of_[at(rows[at(i)])];
      Index end = i;
      while (end < count && panel_of_[at(rows[at(end)])] == target) ++end;
      ranges[at(target)].push_back({d, i, end});
      i = end;
    }
  }

  /// Multiplications and additions of the updates of a panel and of its factorisation.
  double flops_of(Index p, const std::vector<Range>& ranges) const {
    double flops = 0;
    for (const Range& range : ranges) {
      const Index d = range.descendant;
      const double depth = 3.0 * (partition_.start[at(d) + 1] - partition_.start[at(d)]);
      const double columns = 3.0 * (range.end - range.begin);
      const double rows = 3.0 * (static_cast<double>(partition_.rows[at(d)].size()) - range.begin);
      flops += depth * columns * (2 * rows - columns + 1);
    }
    if (p == partition_.count()) return flops;
    const double width = 3.0 * (partition_.start[at(p) + 1] - partition_.start[at(p)]);
    const double under = 3.0 * static_cast<double>(partition_.rows[at(p)].size());
    return flops + width * width * width / 3 + width * width * under;
  }

  void add_panel(Index p, double flops) {
    const std::vector<Index>& rows = partition_.rows[at(p)];
    Panel panel;
    panel.first = partition_.start[at(p)];
    panel.width = partition_.start[at(p) + 1] - panel.first;
    const Index own = 3 * panel.width;
    const auto under = 3 * static_cast<Index>(rows.size());
    panel.flops = flops;
    panel.split = flops > kSplitFlops && under >= kSplitRows;
    panel.below = panel.split ? (own + 2 * kGap - 1) / kGap * kGap : own;
    panel.height = panel.below + under;
    panel.leading = leading_dimension(panel.height);
    panel.offset = s_.doubles;
    panel.parent = panel_of_[at(rows.front())];
    panel.row_begin = static_cast<Index>(s_.rows.size());
    panel.row_end = panel.row_begin + static_cast<Index>(rows.size());
    const auto border = std::lower_bound(rows.begin(), rows.end(), s_.nodes);
    panel.border_row = panel.row_begin + static_cast<Index>(border - rows.begin());
    s_.rows.insert(s_.rows.end(), rows.begin(), rows.end());
    s_.doubles += std::int64_t{panel.leading} * own;
    s_.entries += std::int64_t{own} * (own + 1) / 2 + std::int64_t{own} * under;
    s_.max_leading = std::max(s_.max_leading, panel.leading);
    s_.max_width = std::max(s_.max_width, own);
    s_.flops += flops;
    s_.panels.push_back(panel);
  }

  void add_border_panel(double flops) {
    Panel panel;
    panel.first = s_.nodes;
    panel.width = s_.border_nodes;
    panel.below = panel.height = 3 * panel.width;
    panel.leading = leading_dimension(panel.height);
    panel.row_begin = panel.row_end = panel.border_row = static_cast<Index>(s_.rows.size());
    panel.flops = flops;
    s_.flops += flops;
    s_.max_width = std::max(s_.max_width, 3 * panel.width);
    s_.panels.push_back(panel);
  }

  void add_updates(Index t, const std::vector<Range>& ranges) {
    Panel& target = s_.panels[at(t)];
    place_rows(target);
    target.update_begin = static_cast<Index>(s_.updates.size());
    for (const Range& range : ranges) {
      const Panel& from = s_.panels[at(range.descendant)];
      const std::size_t first_run = s_.runs.size();
      for (Index i = from.row_begin + range.begin; i < from.row_end; ++i) {
        const Index row = place_[at(s_.rows[at(i)])];
        if (s_.runs.size() > first_run && s_.runs.back().target + s_.runs.back().length == row) {
          s_.runs.back().length += 3;
        } else {
          s_.runs.push_back({3 * (i - from.row_begin - range.begin), row, 3});
        }
      }
      Update update{};
      update.descendant = range.descendant;
      update.first = from.below + 3 * range.begin;
      update.rows = 3 * (from.row_end - from.row_begin - range.begin);
      update.columns = 3 * (range.end - range.begin);
      update.run_begin = static_cast<Index>(first_run);
      update.run_end = static_cast<Index>(s_.runs.size());
      update.window_begin = static_cast<Index>(s_.windows.size());
      for (std::size_t r = first_run; r < s_.runs.size(); ++r) add_windows(s_.runs[r], update);
      update.window_end = static_cast<Index>(s_.windows.size());
      s_.updates.push_back(update);
    }
    target.update_end = static_cast<Index>(s_.updates.size());
  }

  void add_windows(const RowRun& run, const Update& update) {
    for (Index i = 0; i < run.length; ++i) {
      const Index row = run.target + i;
      const Index start = row / 8 * 8;
      if (static_cast<Index>(s_.windows.size()) == update.window_begin ||
          s_.windows.back().target != start) {
        s_.windows.push_back({run.source + i, start, 0});
      }
      RowWindow& window = s_.windows.back();
      window.mask = static_cast<std::uint8_t>(window.mask | 1U << (row - start));
    }
  }

  void add_blocks(Panel& panel, const std::vector<Block>& blocks) {
    place_rows(panel);
    const auto add = [&](bool transposed, std::vector<BlockScatter>& list) {
      const auto begin = static_cast<Index>(list.size());
      for (const Block& block : blocks) {
        if (block.transposed != transposed) continue;
        list.push_back({kBlockStride * block.number,
                        3 * (block.column - panel.first) * panel.leading + place_[at(block.row)]});
      }
      return std::pair{begin, static_cast<Index>(list.size())};
    };
    std::tie(panel.straight_begin, panel.straight_end) = add(false, s_.straight);
    std::tie(panel.transposed_begin, panel.transposed_end) = add(true, s_.transposed);
  }

  /// Fills place_ with the panel row of every node in the panel.
  void place_rows(const Panel& panel) {
    for (Index i = 0; i < panel.width; ++i) place_[at(panel.first + i)] = 3 * i;
    for (Index i = panel.row_begin; i < panel.row_end; ++i) {
      place_[at(s_.rows[at(i)])] = panel.below + 3 * (i - panel.row_begin);
    }
  }

  BlockSymbolic& s_;
  const SupernodePartition& partition_;
  std::vector<Index> place_;
  std::vector<Index> panel_of_;
};

/// Splits the panels, in order, into groups of about equal work.
std::vector<Index> group_panels(const BlockSymbolic& s) {
  double total = 0;
  for (Index p = 0; p < s.panel_count(); ++p) total += s.panels[at(p)].flops;
  std::vector<Index> start{0};
  double sum = 0;
  for (Index p = 0; p < s.panel_count(); ++p) {
    sum += s.panels[at(p)].flops;
    if (sum >= total * static_cast<double>(start.size()) / kBorderGroups &&
        p + 1 < s.panel_count()) {
      start.push_back(p + 1);
    }
  }
  start.push_back(s.panel_count());
  return start;
}

}  // namespace

BlockSymbolic::BlockSymbolic(const BlockPattern& pattern, const BorderPattern& border_pattern,
                             Ordering ordering, const SupernodeSettings& settings)
    : nodes(pattern.nodes),
      border_rows(border_pattern.rows()),
      border_nodes(border_pattern.rows() / 3 + 1) {
  const NodeGraph graph(pattern);
  const Elimination elimination(graph, fill_reducing_order(graph, ordering),
                                border_nodes_of(nodes, border_pattern));
  const SupernodePartition partition(elimination, settings);
  order = partition.order;
  position.resize(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) position[at(order[k])] = static_cast<Index>(k);
  PanelBuilder builder(*this, partition);
  builder.lay_out();
  builder.place_blocks(pattern);
  builder.place_border(border_pattern);
  group_start = group_panels(*this);
}

}  // namespace sinew::linalg
