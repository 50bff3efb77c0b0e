#include "sinew/linalg/transient_rows.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "sinew/linalg/dense_kernels.hpp"
#include "sinew/linalg/index.hpp"

namespace sinew::linalg {

namespace {

/// Groups per chunk, and maximum number of groups for a single chunk.
constexpr std::int32_t kChunk = 32, kOneChunk = 48;
/// Number of border columns that are processed at a time.
constexpr int kBorderColumns = 96;

std::int32_t leading_of(std::int32_t groups) { return (3 * groups + kOverrun + 7) / 8 * 8; }

/// Runs tasks 0 .. count-1, assigned to threads by number.
template <typename Work>
void share_out(ThreadPool& pool, int count, Work&& work) {
  if (count == 1 || pool.size() == 1) {
    for (int task = 0; task < count; ++task) work(task, 0);
    return;
  }
  pool.run([&](int thread) {
    for (int task = thread; task < count; task += pool.size()) work(task, thread);
  });
}

}  // namespace

TransientRows::TransientRows(const BlockSymbolic& symbolic) : symbolic_(&symbolic) {}

// Allocates on first use, since most bodies have no transient rows.
void TransientRows::prepare(int threads) {
  if (!scratch_.empty()) return;
  const BlockSymbolic& s = *symbolic_;
  panel_of_.resize(at(s.nodes));
  stamp_.resize(s.panels.size());
  count_.resize(s.panels.size());
  touched_.reserve(s.panels.size());
  for (std::size_t p = 0; p + 1 < s.panels.size(); ++p) {
    const Panel& panel = s.panels[p];
    std::fill_n(panel_of_.begin() + panel.first, panel.width, static_cast<std::int32_t>(p));
  }
  std::int32_t width = 0;
  for (std::size_t p = 0; p + 1 < s.panels.size(); ++p) {
    width = std::max(width, 3 * s.panels[p].width);
  }
  const std::int32_t most = std::max({width, 3 * kOneChunk, kBorderColumns});
  const std::size_t leading = at(leading_of(kOneChunk));
  scratch_.resize(at(threads));
  for (Scratch& scratch : scratch_) {
    scratch.product = AlignedBuffer(leading * at(most) + kOverrun);
    scratch.block = AlignedBuffer(leading * 3 * kOneChunk + kOverrun);
    scratch.signed_rows = AlignedBuffer(at(width) * at(most) + kOverrun);
    scratch.piece_of.assign(s.panels.size(), -1);
    scratch.place.resize(kOneChunk);
    scratch.column_place.resize(at(width) / 3 + 1);
  }
}

// Visits the panels on the paths from the nodes of a group to the root, each once.
template <typename Visit>
void TransientRows::for_panels(const BorderPattern& rows, std::int32_t group, std::int32_t stamp,
                               Visit&& visit) {
  const auto root = static_cast<std::int32_t>(symbolic_->panels.size()) - 1;
  for (int row = 3 * group; row < 3 * group + 3; ++row) {
    for (int e = rows.row_start[at(row)]; e < rows.row_start[at(row) + 1]; ++e) {
      std::int32_t p = panel_of_[at(symbolic_->position[at(rows.node[at(e)])])];
      for (; p != root && stamp_[at(p)] != stamp; p = symbolic_->panels[at(p)].parent) {
        stamp_[at(p)] = stamp;
        visit(p);
      }
    }
  }
}

void TransientRows::order(const BorderPattern& rows) {
  const std::int32_t groups = rows.rows() / 3;
  first_position_.resize(at(groups));
  order_.resize(at(groups));
  std::iota(order_.begin(), order_.end(), 0);
  for (std::int32_t g = 0; g < groups; ++g) {
    std::int32_t first = symbolic_->nodes;
    for (int e = rows.row_start[at(3 * g)]; e < rows.row_start[at(3 * g + 3)]; ++e) {
      first = std::min(first, symbolic_->position[at(rows.node[at(e)])]);
    }
    first_position_[at(g)] = first;
  }
  std::ranges::sort(order_, [&](std::int32_t a, std::int32_t b) {
    return std::pair(first_position_[at(a)], a) < std::pair(first_position_[at(b)], b);
  });
}

void TransientRows::list(const BorderPattern& rows) {
  order(rows);
  const std::int32_t groups = rows.rows() / 3;
  const std::int32_t parts = groups <= kOneChunk ? 1 : (groups + kChunk - 1) / kChunk;
  std::ranges::fill(stamp_, -1);
  chunks_.clear();
  pieces_.clear();
  members_.clear();
  for (std::int32_t k = 0; k < parts; ++k) {
    const std::int32_t first = groups * k / parts;
    chunks_.push_back({first, groups * (k + 1) / parts - first, 0, 0});
    list_chunk(rows, chunks_.back());
  }
  std::int64_t doubles = 0;
  for (Piece& piece : pieces_) {
    piece.offset = doubles;
    doubles += std::int64_t{piece.leading} * 3 * symbolic_->panels[at(piece.panel)].width;
  }
  if (values_.size() < at(doubles) + kOverrun) values_ = AlignedBuffer(at(doubles) + kOverrun);
  if (coupling_.rows() < rows.rows()) {
    const Eigen::Index room = coupling_.rows() + coupling_.rows() / 6 * 3;
    const Eigen::Index most = std::max<Eigen::Index>(rows.rows(), room);
    compliance_.resize(most, most);
    coupling_.resize(most, 3 * symbolic_->border_nodes);
  }
}

void TransientRows::list_chunk(const BorderPattern& rows, Chunk& chunk) {
  touched_.clear();
  // Stamps are different for each group and pass.
  for (std::int32_t k = chunk.first; k < chunk.first + chunk.groups; ++k) {
    for_panels(rows, order_[at(k)], 2 * k, [&](std::int32_t p) {
      if (count_[at(p)]++ == 0) touched_.push_back(p);
    });
  }
  std::ranges::sort(touched_);
  chunk.begin = pieces_.size();
  for (const std::int32_t p : touched_) {
    const std::int32_t count = count_[at(p)];
    pieces_.push_back({p, 0, leading_of(count), 0, members_.size()});
    members_.resize(members_.size() + at(count));
    count_[at(p)] = static_cast<std::int32_t>(pieces_.size()) - 1;
  }
  chunk.end = pieces_.size();
  for (std::int32_t k = chunk.first; k < chunk.first + chunk.groups; ++k) {
    for_panels(rows, order_[at(k)], 2 * k + 1, [&](std::int32_t p) {
      Piece& piece = pieces_[at(count_[at(p)])];
      members_[piece.first_member + at(piece.count++)] = k - chunk.first;
    });
  }
  for (const std::int32_t p : touched_) count_[at(p)] = 0;
}

void TransientRows::fill(const Chunk& chunk, const Piece& piece, const BorderPattern& rows,
                         std::span<const double> values) {
  const Panel& panel = symbolic_->panels[at(piece.panel)];
  double* const x = values_of(piece);
  std::fill_n(x, std::int64_t{piece.leading} * 3 * panel.width, 0.0);
  const auto groups = members(piece);
  for (std::size_t slot = 0; slot < groups.size(); ++slot) {
    const int first = 3 * order_[at(chunk.first + groups[slot])];
    for (int r = 0; r < 3; ++r) {
      for (int e = rows.row_start[at(first + r)]; e < rows.row_start[at(first + r) + 1]; ++e) {
        const int column = symbolic_->position[at(rows.node[at(e)])] - panel.first;
        if (column < 0 || column >= panel.width) continue;
        for (int c = 0; c < 3; ++c) {
          x[(3 * column + c) * piece.leading + 3 * static_cast<long>(slot) + r] =
              values[at(3 * e + c)];
        }
      }
    }
  }
}

// Rows times S, if S is not the identity.
TransientRows::Rows TransientRows::with_signs(const BlockNumeric& numeric, const Panel& panel,
                                              bool positive, Rows rows, int count,
                                              Scratch& scratch) {
  if (positive) return rows;
  double* const to = scratch.signed_rows.data();
  for (int k = 0; k < 3 * panel.width; ++k) {
    const double sign = numeric.sign(panel)[k];
    for (int j = 0; j < count; ++j) to[k * count + j] = sign * rows.values[k * rows.leading + j];
  }
  return {to, count};
}

// X_p -= X_d S L_d(p)^T of every descendant d.
void TransientRows::update(const BlockNumeric& numeric, const Piece& piece, Scratch& scratch) {
  const BlockSymbolic& s = *symbolic_;
  const Panel& panel = s.panels[at(piece.panel)];
  double* const x = values_of(piece);
  const auto groups = members(piece);
  for (int u = panel.update_begin; u < panel.update_end; ++u) {
    const Update& update = s.updates[at(u)];
    if (scratch.piece_of[at(update.descendant)] < 0) continue;
    const Piece& from = pieces_[at(scratch.piece_of[at(update.descendant)])];
    const Panel& descendant = s.panels[at(update.descendant)];
    const Rows factor = with_signs(numeric, descendant, numeric.positive(update.descendant),
                                   {numeric.values(descendant) + update.first, descendant.leading},
                                   update.columns, scratch);
    const Product product{values_of(from), from.leading,         factor.values,
                          factor.leading,  3 * descendant.width, update.columns};
    const RowRun* run = s.runs.data() + update.run_begin;
    if (from.count == piece.count && run->length >= update.columns) {  // all groups, contiguous
      multiply(product, 0, 3 * from.count, x + run->target * long{piece.leading}, piece.leading,
               Store::subtract);
      continue;
    }
    for (int placed = 0; 3 * placed < update.columns; ++run) {
      for (int i = 0; i < run->length && 3 * placed < update.columns; i += 3) {
        scratch.column_place[at(placed++)] = run->target + i;
      }
    }
    const auto moved = members(from);
    for (std::size_t k = 0, slot = 0; k < moved.size(); ++k) {
      while (groups[slot] != moved[k]) ++slot;
      scratch.place[k] = static_cast<std::int32_t>(3 * slot);
    }
    multiply(product, 0, 3 * from.count, scratch.product.data(), from.leading, Store::assign);
    for (int j = 0; j < update.columns; ++j) {
      double* const to = x + (scratch.column_place[at(j / 3)] + j % 3) * long{piece.leading};
      const double* const w = scratch.product.data() + j * long{from.leading};
      for (std::size_t k = 0; k < moved.size(); ++k) {
        for (int r = 0; r < 3; ++r) to[scratch.place[k] + r] -= w[3 * k + at(r)];
      }
    }
  }
}

void TransientRows::couple(const BlockNumeric& numeric, const Chunk& chunk, const Piece& piece,
                           Scratch& scratch) {
  const BlockSymbolic& s = *symbolic_;
  const Panel& panel = s.panels[at(piece.panel)];
  const auto groups = members(piece);
  const int end = 3 * (panel.row_end - panel.border_row);
  const double* const border =
      numeric.values(panel) + panel.below + 3L * (panel.border_row - panel.row_begin);
  for (int first = 0; first < end; first += kBorderColumns) {
    const int columns = std::min(kBorderColumns, end - first);
    const Rows own = with_signs(numeric, panel, numeric.positive(piece.panel),
                                {border + first, panel.leading}, columns, scratch);
    const Product across{values_of(piece), piece.leading,   own.values,
                         own.leading,      3 * panel.width, columns};
    multiply(across, 0, 3 * piece.count, scratch.product.data(), piece.leading, Store::assign);
    for (int j = 0; j < columns; ++j) {
      const int place = first + j;
      const int column = 3 * (s.rows[at(panel.border_row + place / 3)] - s.nodes) + place % 3;
      double* const to = coupling_.col(column).data();
      const double* const w = scratch.product.data() + j * long{piece.leading};
      for (std::size_t k = 0; k < groups.size(); ++k) {
        const long row = 3L * order_[at(chunk.first + groups[k])];
        for (int r = 0; r < 3; ++r) to[row + r] += w[3 * k + at(r)];
      }
    }
  }
}

void TransientRows::substitute(BlockNumeric& numeric, const Chunk& chunk, const BorderPattern& rows,
                               std::span<const double> values, int thread) {
  Scratch& scratch = scratch_[at(thread)];
  for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
    const Piece& piece = pieces_[k];
    fill(chunk, piece, rows, values);
    update(numeric, piece, scratch);
    solve_rows_apart(numeric.diagonal_block(piece.panel, numeric.scratch(thread)), values_of(piece),
                     piece.leading, 3 * piece.count);
    couple(numeric, chunk, piece, scratch);
    scratch.piece_of[at(piece.panel)] = static_cast<std::int32_t>(k);
  }
  for (std::size_t k = chunk.begin; k < chunk.end; ++k) {
    scratch.piece_of[at(pieces_[k].panel)] = -1;
  }
}

// X S X^T of the rows of one chunk with those of the same or an earlier chunk.
void TransientRows::multiply_chunks(const BlockNumeric& numeric, const Chunk& left,
                                    const Chunk& right, Scratch& scratch) {
  const Part part = &left == &right ? Part::lower : Part::whole;
  const long leading = leading_of(left.groups);
  double* const block = scratch.block.data();
  std::fill_n(block, leading * 3 * right.groups, 0.0);
  std::size_t a = left.begin, b = right.begin;
  while (a < left.end && b < right.end) {
    if (pieces_[a].panel != pieces_[b].panel) {
      ++(pieces_[a].panel < pieces_[b].panel ? a : b);
      continue;
    }
    const Piece& one = pieces_[a++];
    const Piece& other = pieces_[b++];
    const Panel& panel = symbolic_->panels[at(one.panel)];
    const Rows columns = with_signs(numeric, panel, numeric.positive(one.panel),
                                    {values_of(other), other.leading}, 3 * other.count, scratch);
    const Product product{values_of(one),  one.leading,     columns.values,
                          columns.leading, 3 * panel.width, 3 * other.count};
    if (one.count == left.groups && other.count == right.groups) {
      multiply(product, 0, 3 * one.count, block, leading, Store::add, part);
      continue;
    }
    multiply(product, 0, 3 * one.count, scratch.product.data(), one.leading, Store::assign, part);
    const auto row = members(one), column = members(other);
    for (int j = 0; j < 3 * other.count; ++j) {
      double* const to = block + (3 * column[at(j / 3)] + j % 3) * leading;
      const double* const w = scratch.product.data() + j * long{one.leading};
      for (std::size_t k = part == Part::lower ? at(j / 3) : 0; k < row.size(); ++k) {
        for (int r = 0; r < 3; ++r) to[3 * row[k] + r] += w[3 * k + at(r)];
      }
    }
  }
  place_block(left, right, block, leading);
}

// Copies a block to its place in the lower triangle, in the order of the caller.
void TransientRows::place_block(const Chunk& left, const Chunk& right, const double* block,
                                long leading) {
  for (int j = 0; j < right.groups; ++j) {
    const int column = 3 * order_[at(right.first + j)];
    for (int i = &left == &right ? j : 0; i < left.groups; ++i) {
      const int row = 3 * order_[at(left.first + i)];
      const double* const from = block + 3 * i + 3 * j * leading;
      const bool below = row >= column;
      double* const to = &compliance_(below ? row : column, below ? column : row);
      const Eigen::Index next = compliance_.rows();
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) to[below ? r + c * next : c + r * next] = from[r + c * leading];
      }
    }
  }
}

void TransientRows::condense(BlockNumeric& numeric, const BorderPattern& rows,
                             std::span<const double> values, ThreadPool& pool) {
  prepare(pool.size());
  list(rows);
  coupling_.topRows(rows.rows()).setZero();
  if (rows.rows() == 0) return;
  const auto count = static_cast<int>(chunks_.size());
  share_out(pool, count, [&](int chunk, int thread) {
    substitute(numeric, chunks_[at(chunk)], rows, values, thread);
  });
  // Pairs (left, right) with right <= left, row by row.
  share_out(pool, count * (count + 1) / 2, [&](int pair, int thread) {
    int left = 0;
    while ((left + 1) * (left + 2) / 2 <= pair) ++left;
    const int right = pair - left * (left + 1) / 2;
    multiply_chunks(numeric, chunks_[at(left)], chunks_[at(right)], scratch_[at(thread)]);
  });
}

std::size_t TransientRows::bytes() const {
  std::size_t total = values_.bytes() + sizeof(double) * static_cast<std::size_t>(
                                                             coupling_.size() + compliance_.size());
  for (const Scratch& scratch : scratch_) {
    total += scratch.product.bytes() + scratch.signed_rows.bytes() + scratch.block.bytes();
  }
  return total + sizeof(std::int32_t) * (members_.size() + panel_of_.size()) +
         sizeof(Piece) * pieces_.size();
}

}  // namespace sinew::linalg
