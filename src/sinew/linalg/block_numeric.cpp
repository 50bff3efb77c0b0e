#include "sinew/linalg/block_numeric.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <utility>

#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/index.hpp"
#include "sinew/linalg/row_spread.hpp"

namespace sinew::linalg {

namespace {

/// Number of row windows of an update that are multiplied before they are spread, so that product
/// and operands stay in the second-level cache.
constexpr int kWindows = 12;
constexpr int kRowBlock = 8 * kWindows;

void place_straight(const double* block, double* to, long leading) {
  for (int c = 0; c < 3; ++c) std::memcpy(to + c * leading, block + 4 * c, 3 * sizeof(double));
}

void place_transposed(const double* block, double* to, long leading) {
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) to[c * leading + r] = block[4 * r + c];
  }
}

}  // namespace

BlockNumeric::BlockNumeric(const BlockSymbolic& symbolic, std::shared_ptr<FactorMemory> memory,
                           int threads)
    : symbolic_(&symbolic),
      memory_(std::move(memory)),
      inverse_(3 * at(symbolic.nodes)),
      sign_(3 * at(symbolic.nodes)),
      negatives_(at(symbolic.panel_count())),
      singular_(at(symbolic.panel_count())),
      scratch_(at(threads)) {
  const std::size_t groups = symbolic.group_start.size() - 1;
  const Panel& border = symbolic.border_panel();
  border_sums_ = AlignedBuffer(groups * 3 * at(border.width) * at(border.leading) + kOverrun);
  const std::size_t width = at(symbolic.max_width);
  std::size_t signed_rows = 6 * width;  // for the diagonal block and the largest update
  for (const Update& update : symbolic.updates) {
    const int depth = 3 * symbolic.panels[at(update.descendant)].width;
    signed_rows = std::max(signed_rows, at(depth) * at(update.columns));
  }
  for (Scratch& scratch : scratch_) {
    scratch.product = AlignedBuffer((kRowBlock + kOverrun) * width + kOverrun);
    scratch.signed_rows = AlignedBuffer(signed_rows + kOverrun);
    scratch.values = AlignedBuffer(at(symbolic.max_leading) + kOverrun);
    scratch.column_place.resize(width / 3);
  }
}

std::size_t BlockNumeric::factor_size(const BlockSymbolic& symbolic) {
  return static_cast<std::size_t>(symbolic.doubles) + kOverrun;
}

void BlockNumeric::begin() {
  if (!holds_factor()) factor_ = memory_->take();
}

void BlockNumeric::release() {
  if (holds_factor()) memory_->give_back(std::exchange(factor_, {}));
}

void BlockNumeric::assemble(int p, const BlockInput& input) {
  const BlockSymbolic& s = *symbolic_;
  const Panel& panel = s.panels[at(p)];
  double* const values = factor_.data() + panel.offset;
  const long leading = panel.leading;
  std::fill_n(values, 3 * panel.width * leading, 0.0);
  for (int e = panel.straight_begin; e < panel.straight_end; ++e) {
    const BlockScatter& block = s.straight[at(e)];
    place_straight(input.matrix + block.source, values + block.target, leading);
  }
  for (int e = panel.transposed_begin; e < panel.transposed_end; ++e) {
    const BlockScatter& block = s.transposed[at(e)];
    place_transposed(input.matrix + block.source, values + block.target, leading);
  }
  for (int e = panel.border_begin; e < panel.border_end; ++e) {
    const BlockScatter& block = s.border[at(e)];
    for (int c = 0; c < 3; ++c) values[block.target + c * leading] = input.border[block.source + c];
  }
  double* right = values + panel.right_row;
  for (int i = 0; i < panel.width; ++i) {
    const double* b = input.right + 3 * s.order[at(panel.first + i)];
    for (int c = 0; c < 3; ++c, right += leading) *right = b[c];
  }
  for (int j = 0; j < 3 * panel.width; ++j) {
    inverse_.data()[3 * panel.first + j] = std::abs(values[j * leading + j]);
  }
}

void BlockNumeric::apply(const Update& update, const Panel& target, double* panel, int row_begin,
                         int row_end, Scratch& scratch) const {
  const BlockSymbolic& s = *symbolic_;
  const Panel& from = s.panels[at(update.descendant)];
  const double* const a = factor_.data() + from.offset + update.first;
  const int depth = 3 * from.width;
  Product product{a, from.leading, a, from.leading, depth, update.columns};
  if (negatives_[at(update.descendant)] > 0) {
    double* const rows = scratch.signed_rows.data();
    for (int k = 0; k < depth; ++k) {
      const double sign = sign_.data()[3 * from.first + k];
      for (int j = 0; j < update.columns; ++j) {
        rows[k * update.columns + j] = a[k * from.leading + j] * sign;
      }
    }
    product.b = rows;
    product.leading_b = update.columns;
  }
  const std::span<const RowRun> runs(s.runs.data() + update.run_begin,
                                     s.runs.data() + update.run_end);
  const long leading = target.leading;
  if (runs.size() == 1 && !target.split) {  // contiguous rows up to the end of the panel
    const int row = runs[0].target;
    multiply(product, 0, update.rows, panel + row + row * leading, leading, Store::subtract,
             Part::lower);
    return;
  }
  int placed = 0;
  for (auto run = runs.begin(); 3 * placed < update.columns; ++run) {
    for (int i = 0; i < run->length && 3 * placed < update.columns; i += 3) {
      scratch.column_place[at(placed++)] = run->target + i;
    }
  }
  Spread spread;
  spread.runs = runs;
  spread.column_place = scratch.column_place.data();
  spread.columns = update.columns;
  spread.product = scratch.product.data();
  spread.panel = panel;
  spread.leading = leading;
  const RowWindow* window = s.windows.data() + update.window_begin;
  const RowWindow* last = s.windows.data() + update.window_end;
  while (window != last && window->target < row_begin) ++window;
  while (window != last && (last - 1)->target >= row_end) --last;
  while (window != last) {
    const RowWindow* const block_end = window + std::min<std::ptrdiff_t>(last - window, kWindows);
    spread.windows = {window, block_end};
    spread.begin = window->source;
    spread.end = (block_end - 1)->source + std::popcount((block_end - 1)->mask);
    spread.leading_product = (spread.end - spread.begin + kOverrun + 3) / 4 * 4;
    multiply(product, spread.begin, spread.end, scratch.product.data(), spread.leading_product,
             Store::assign, Part::lower);
    spread_rows(spread);
    window = block_end;
  }
}

void BlockNumeric::update(int p, int row_begin, int row_end, Scratch& scratch) {
  const Panel& panel = symbolic_->panels[at(p)];
  double* const values = factor_.data() + panel.offset;
  for (int u = panel.update_begin; u < panel.update_end; ++u) {
    apply(symbolic_->updates[at(u)], panel, values, row_begin, row_end, scratch);
  }
}

DiagonalBlock BlockNumeric::diagonal_block(int p, Scratch& scratch) {
  const Panel& panel = symbolic_->panels[at(p)];
  DiagonalBlock block{};
  block.panel = factor_.data() + panel.offset;
  block.leading = panel.leading;
  block.columns = 3 * panel.width;
  block.inverse = inverse_.data() + 3 * panel.first;
  block.sign = sign_.data() + 3 * panel.first;
  block.negatives = negatives_[at(p)];
  block.scratch = scratch.signed_rows.data();
  return block;
}

void BlockNumeric::factorise(int p, Scratch& scratch) {
  const Panel& panel = symbolic_->panels[at(p)];
  DiagonalBlock block = diagonal_block(p, scratch);
  factorise_panel(block, panel.split ? block.columns : panel.height);
  negatives_[at(p)] = block.negatives;
  singular_[at(p)] = block.singular ? 1 : 0;
}

void BlockNumeric::solve_rows(int p, int row_begin, int row_end, Scratch& scratch) {
  solve_panel_rows(diagonal_block(p, scratch), row_begin, row_end);
}

void BlockNumeric::update_border(int group, Scratch& scratch) {
  const BlockSymbolic& s = *symbolic_;
  const Panel& border = s.border_panel();
  const long size = 3L * border.width * border.leading;
  double* const sum = border_sums_.data() + group * size;
  std::fill_n(sum, size, 0.0);
  // Every panel updates the border once (b touches all), so update i is that of panel i.
  for (int p = s.group_start[at(group)]; p < s.group_start[at(group) + 1]; ++p) {
    apply(s.updates[at(border.update_begin + p)], border, sum, 0, border.height, scratch);
  }
}

void BlockNumeric::finish_border() {
  const BlockSymbolic& s = *symbolic_;
  const Panel& border = s.border_panel();
  const int size = 3 * border.width * border.leading;
  double* const sum = border_sums_.data();
  for (std::size_t g = 1; g + 1 < s.group_start.size(); ++g) {
    const double* const part = sum + g * at(size);
    for (int i = 0; i < size; ++i) sum[i] += part[i];
  }
}

void BlockNumeric::forward(double* x, Scratch& scratch) const {
  const BlockSymbolic& s = *symbolic_;
  double* const v = scratch.values.data();
  for (int p = 0; p < s.panel_count(); ++p) {
    const Panel& panel = s.panels[at(p)];
    const int own = 3 * panel.width;
    double* const mine = x + 3 * panel.first;
    std::copy_n(mine, own, v);
    std::fill(v + own, v + panel.leading, 0.0);
    const int height = panel.below + 3 * (panel.border_row - panel.row_begin);
    forward_panel(factor_.data() + panel.offset, panel.leading, own, height,
                  inverse_.data() + 3 * panel.first, v);
    const double* const sign = sign_.data() + 3 * panel.first;
    for (int j = 0; j < own; ++j) mine[j] = v[j] * sign[j];
    const double* below = v + panel.below;
    for (int i = panel.row_begin; i < panel.border_row; ++i, below += 3) {
      double* const to = x + 3 * s.rows[at(i)];
      for (int c = 0; c < 3; ++c) to[c] += below[c];
    }
  }
}

void BlockNumeric::renew_right(const double* x, double* products) {
  const BlockSymbolic& s = *symbolic_;
  std::fill_n(products, 3 * s.border_nodes, 0.0);
  double* const sum = scratch(0).values.data();
  for (int p = 0; p < s.panel_count(); ++p) {
    const Panel& panel = s.panels[at(p)];
    double* column = factor_.data() + panel.offset;
    const double* const own = x + 3 * panel.first;
    const double* const sign = sign_.data() + 3 * panel.first;
    const int first = panel.below + 3 * (panel.border_row - panel.row_begin);
    const int rows = 3 * (panel.row_end - panel.border_row);
    std::fill_n(sum, rows, 0.0);
    for (int j = 0; j < 3 * panel.width; ++j, column += panel.leading) {
      column[panel.right_row] = own[j];
      const double factor = sign[j] * own[j];
      for (int r = 0; r < rows; ++r) sum[r] += column[first + r] * factor;
    }
    for (int r = 0; r < rows; ++r) {
      products[3 * (s.rows[at(panel.border_row + r / 3)] - s.nodes) + r % 3] += sum[r];
    }
  }
}

void BlockNumeric::backward(double* x, const double* weights, Scratch& scratch) const {
  const BlockSymbolic& s = *symbolic_;
  double* const v = scratch.values.data();
  for (int p = s.panel_count(); p-- > 0;) {
    const Panel& panel = s.panels[at(p)];
    const int own = 3 * panel.width;
    double* const mine = x + 3 * panel.first;
    std::copy_n(mine, own, v);
    std::fill(v + own, v + panel.below, 0.0);
    double* below = v + panel.below;
    for (int i = panel.row_begin; i < panel.border_row; ++i, below += 3) {
      std::copy_n(x + 3 * s.rows[at(i)], 3, below);
    }
    for (int i = panel.border_row; i < panel.row_end; ++i, below += 3) {
      const double* const weight = weights + 3 * (s.rows[at(i)] - s.nodes);
      for (int c = 0; c < 3; ++c) below[c] = -weight[c];
    }
    std::fill(v + panel.height, v + panel.leading, 0.0);
    backward_panel(factor_.data() + panel.offset, panel.leading, own, panel.height,
                   inverse_.data() + 3 * panel.first, v);
    std::copy_n(v, own, mine);
  }
}

double BlockNumeric::border(int i, int j) const {
  return border_sums_.data()[j * symbolic_->border_panel().leading + i];
}

int BlockNumeric::negative_pivots() const {
  return std::accumulate(negatives_.begin(), negatives_.end(), 0);
}

bool BlockNumeric::singular() const {
  return std::any_of(singular_.begin(), singular_.end(), [](unsigned char s) { return s != 0; });
}

std::size_t BlockNumeric::bytes() const {
  std::size_t total = factor_.bytes() + inverse_.bytes() + sign_.bytes() + border_sums_.bytes();
  for (const Scratch& scratch : scratch_) {
    total += scratch.product.bytes() + scratch.signed_rows.bytes() + scratch.values.bytes();
  }
  return total + sizeof(*this) + negatives_.size() * sizeof(int) + singular_.size();
}

}  // namespace sinew::linalg
