#include "sinew/linalg/transient_rows.hpp"

#include <algorithm>

#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

std::int32_t leading_of(std::int32_t groups) { return (3 * groups + kOverrun + 7) / 8 * 8; }

}  // namespace

TransientRows::TransientRows(const BlockSymbolic& symbolic) : symbolic_(&symbolic) {}

// Most bodies never have such rows: no memory is taken before.
void TransientRows::prepare() {
  if (!stores_.empty()) return;
  panel_of_.resize(at(symbolic_->nodes));
  stamp_.resize(symbolic_->panels.size());
  stores_.resize(symbolic_->panels.size());
  column_place_.resize(at(symbolic_->max_width));
  for (std::size_t p = 0; p + 1 < symbolic_->panels.size(); ++p) {
    const Panel& panel = symbolic_->panels[p];
    std::fill_n(panel_of_.begin() + panel.first, panel.width, static_cast<std::int32_t>(p));
  }
}

// The panels on the ways from a group's nodes to the root, each once.
template <typename Visit>
void TransientRows::for_panels(const BorderPattern& rows, std::int32_t group, Visit&& visit) {
  const auto root = static_cast<std::int32_t>(symbolic_->panels.size()) - 1;
  for (int row = 3 * group; row < 3 * group + 3; ++row) {
    for (int e = rows.row_start[at(row)]; e < rows.row_start[at(row) + 1]; ++e) {
      std::int32_t p = panel_of_[at(symbolic_->position[at(rows.node[at(e)])])];
      for (; p != root && stamp_[at(p)] != group; p = symbolic_->panels[at(p)].parent) {
        stamp_[at(p)] = group;
        visit(p);
      }
    }
  }
}

void TransientRows::list(const BorderPattern& rows) {
  const std::int32_t groups = rows.rows() / 3;
  for (Store& store : stores_) store.count = 0;
  std::ranges::fill(stamp_, -1);
  for (std::int32_t group = 0; group < groups; ++group) {
    for_panels(rows, group, [&](int p) { ++stores_[at(p)].count; });
  }
  std::int64_t doubles = 0;
  std::size_t entries = 0;
  for (std::size_t p = 0; p < stores_.size(); ++p) {
    Store& store = stores_[p];
    store.leading = leading_of(store.count);
    store.offset = doubles;
    store.first_member = entries;
    if (store.count > 0) doubles += std::int64_t{store.leading} * 3 * symbolic_->panels[p].width;
    entries += at(store.count);
    store.count = 0;
  }
  make_room(groups, at(doubles), entries);
  std::ranges::fill(stamp_, -1);
  for (std::int32_t group = 0; group < groups; ++group) {
    for_panels(rows, group, [&](int p) {
      Store& store = stores_[at(p)];
      members_[store.first_member + at(store.count++)] = group;
    });
  }
}

// Memory grows with the rows that are there; it is never given back.
void TransientRows::make_room(std::int32_t groups, std::size_t doubles, std::size_t entries) {
  const auto grow = [](AlignedBuffer& buffer, std::size_t count) {
    if (buffer.size() < count + kOverrun) buffer = AlignedBuffer(count + kOverrun);
  };
  grow(values_, doubles);
  if (members_.size() < entries) members_.resize(entries);
  if (groups <= room_) return;
  room_ = std::max(groups, room_ + room_ / 2);
  const std::int64_t columns =
      std::max({symbolic_->max_width, 3 * room_, 3 * symbolic_->border_nodes});
  std::int64_t signs = 0;
  for (std::size_t p = 0; p + 1 < symbolic_->panels.size(); ++p) {
    const Panel& panel = symbolic_->panels[p];
    const std::int64_t rows_here = std::max(panel.leading, leading_of(room_));
    signs = std::max(signs, rows_here * 3 * panel.width);
  }
  grow(product_, at(leading_of(room_) * columns));
  grow(signed_, at(signs));
  place_.resize(at(room_));
  compliance_.resize(3 * room_, 3 * room_);
  coupling_.resize(3 * room_, 3 * symbolic_->border_nodes);
}

void TransientRows::fill(int p, const BorderPattern& rows, std::span<const double> values) {
  const Panel& panel = symbolic_->panels[at(p)];
  const Store& store = stores_[at(p)];
  double* const x = values_.data() + store.offset;
  std::fill_n(x, std::int64_t{store.leading} * 3 * panel.width, 0.0);
  const auto groups = members(p);
  for (std::size_t slot = 0; slot < groups.size(); ++slot) {
    const int first = 3 * groups[slot];
    for (int r = 0; r < 3; ++r) {
      for (int e = rows.row_start[at(first + r)]; e < rows.row_start[at(first + r) + 1]; ++e) {
        const int column = symbolic_->position[at(rows.node[at(e)])] - panel.first;
        if (column < 0 || column >= panel.width) continue;
        for (int c = 0; c < 3; ++c) {
          x[(3 * column + c) * store.leading + 3 * static_cast<long>(slot) + r] =
              values[at(3 * e + c)];
        }
      }
    }
  }
}

// Rows times S, where S is not the identity.
const double* TransientRows::with_signs(const BlockNumeric& numeric, int p, const double* rows,
                                        long leading, int count) {
  if (numeric.positive(p)) return rows;
  const Panel& panel = symbolic_->panels[at(p)];
  for (int k = 0; k < 3 * panel.width; ++k) {
    const double sign = numeric.sign(panel)[k];
    for (int j = 0; j < count; ++j) signed_.data()[k * leading + j] = sign * rows[k * leading + j];
  }
  return signed_.data();
}

// X_p -= X_d S L_d(p)^T of every descendant d.
void TransientRows::update(BlockNumeric& numeric, int p) {
  const BlockSymbolic& s = *symbolic_;
  const Panel& panel = s.panels[at(p)];
  const Store& store = stores_[at(p)];
  double* const x = values_.data() + store.offset;
  const auto groups = members(p);
  for (int u = panel.update_begin; u < panel.update_end; ++u) {
    const Update& update = s.updates[at(u)];
    const Store& from = stores_[at(update.descendant)];
    if (from.count == 0) continue;
    const Panel& descendant = s.panels[at(update.descendant)];
    int placed = 0;
    for (const RowRun* run = s.runs.data() + update.run_begin; 3 * placed < update.columns; ++run) {
      for (int i = 0; i < run->length && 3 * placed < update.columns; i += 3) {
        column_place_[at(placed++)] = run->target + i;
      }
    }
    const auto moved = members(update.descendant);
    for (std::size_t k = 0, slot = 0; k < moved.size(); ++k) {
      while (groups[slot] != moved[k]) ++slot;
      place_[k] = static_cast<std::int32_t>(3 * slot);
    }
    const double* const rows =
        with_signs(numeric, update.descendant, numeric.values(descendant) + update.first,
                   descendant.leading, update.columns);
    const Product product{values_.data() + from.offset, from.leading,         rows,
                          descendant.leading,           3 * descendant.width, update.columns};
    multiply_whole(product, 3 * from.count, product_.data(), from.leading);
    for (int j = 0; j < update.columns; ++j) {
      double* const to = x + (column_place_[at(j / 3)] + j % 3) * long{store.leading};
      const double* const w = product_.data() + j * long{from.leading};
      for (std::size_t k = 0; k < moved.size(); ++k) {
        for (int r = 0; r < 3; ++r) to[place_[k] + r] -= w[3 * k + at(r)];
      }
    }
  }
}

void TransientRows::add_compliance(const BlockNumeric& numeric, int p) {
  const BlockSymbolic& s = *symbolic_;
  const Panel& panel = s.panels[at(p)];
  const Store& store = stores_[at(p)];
  const auto groups = members(p);
  const int count = 3 * store.count;
  const double* const x = values_.data() + store.offset;
  const double* const own = with_signs(numeric, p, x, store.leading, count);
  const Product square{x, store.leading, own, store.leading, 3 * panel.width, count};
  multiply(square, 0, count, product_.data(), store.leading);
  for (int j = 0; j < count; ++j) {
    double* const to = compliance_.col(3 * groups[at(j / 3)] + j % 3).data();
    const double* const w = product_.data() + j * long{store.leading};
    for (std::size_t k = at(j / 3); k < groups.size(); ++k) {
      for (int r = 0; r < 3; ++r) to[3 * groups[k] + r] += w[3 * k + at(r)];
    }
  }
  const int nodes = panel.row_end - panel.border_row;
  const double* const border = with_signs(
      numeric, p, numeric.values(panel) + panel.below + 3L * (panel.border_row - panel.row_begin),
      panel.leading, 3 * nodes);
  const Product across{x, store.leading, border, panel.leading, 3 * panel.width, 3 * nodes};
  multiply_whole(across, count, product_.data(), store.leading);
  for (int j = 0; j < 3 * nodes; ++j) {
    const int column = 3 * (s.rows[at(panel.border_row + j / 3)] - s.nodes) + j % 3;
    double* const to = coupling_.col(column).data();
    const double* const w = product_.data() + j * long{store.leading};
    for (std::size_t k = 0; k < groups.size(); ++k) {
      for (int r = 0; r < 3; ++r) to[3 * groups[k] + r] += w[3 * k + at(r)];
    }
  }
}

void TransientRows::condense(BlockNumeric& numeric, const BorderPattern& rows,
                             std::span<const double> values) {
  prepare();
  list(rows);
  const auto count = static_cast<Eigen::Index>(rows.rows());
  compliance_.topLeftCorner(count, count).setZero();
  coupling_.topRows(count).setZero();
  BlockNumeric::Scratch& scratch = numeric.scratch(0);
  for (int p = 0; p < symbolic_->panel_count(); ++p) {
    const Store& store = stores_[at(p)];
    if (store.count == 0) continue;
    fill(p, rows, values);
    update(numeric, p);
    solve_rows_apart(numeric.diagonal_block(p, scratch), values_.data() + store.offset,
                     store.leading, 3 * store.count);
    add_compliance(numeric, p);
  }
}

std::size_t TransientRows::bytes() const {
  return values_.bytes() + product_.bytes() + signed_.bytes() +
         sizeof(double) * static_cast<std::size_t>(compliance_.size() + coupling_.size()) +
         sizeof(std::int32_t) * (members_.size() + panel_of_.size());
}

}  // namespace sinew::linalg
