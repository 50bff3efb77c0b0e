/// @file
/// The rows of the world that touch one body with many coordinates, and their pattern there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/linalg/block_pattern.hpp"
#include "sinew/mechanics/block_sites.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::mechanics {

/// Rows of one body. Persistent rows have a fixed pattern, the border of the body's factorisation;
/// that of transient rows is found in each step. Immutable, and shared by simulations.
class SparseRowPlan {
 public:
  /// value[3 position ..] += the part of `block` in direction[entry], for every block of every
  /// entry of a persistent row.
  struct Scatter {
    std::int32_t entry = 0;     ///< in the RowValues of the world
    std::int32_t position = 0;  ///< in the entries of the border
    std::int32_t site = 0;      ///< on the body
    SiteBlock block;
  };

  SparseRowPlan() = default;
  /// @param body position in the world. @param world all rows. @param sites of the body.
  SparseRowPlan(int body, RowPattern world, BlockSites sites);

  /// World rows that touch the body: persistent rows, then transient rows, each ascending.
  std::span<const std::int32_t> rows() const { return rows_; }
  std::span<const std::int32_t> persistent() const { return rows().first(persistent_); }
  std::span<const std::int32_t> transient() const { return rows().subspan(persistent_); }

  const linalg::BorderPattern& border() const { return border_; }  ///< of the persistent rows
  std::span<const Scatter> scatter() const { return scatter_; }

  const BlockSites& sites() const { return sites_; }
  /// Calls visit(entry) for the entries of a world row on this body.
  template <class Visit>
  void for_each_entry(std::int32_t row, Visit&& visit) const {
    const auto k = static_cast<std::size_t>(row);
    for (auto e = world_.row_start[k]; e < world_.row_start[k + 1]; ++e) {
      if (world_.site[static_cast<std::size_t>(e)].body == body_) visit(e);
    }
  }
  /// Number on the body of the site of an entry.
  int site_of(std::int32_t entry) const {
    return world_.site[static_cast<std::size_t>(entry)].number;
  }

 private:
  void add_border_row(std::int32_t row);

  int body_ = -1;
  RowPattern world_;
  BlockSites sites_;
  std::vector<std::int32_t> rows_;
  std::size_t persistent_ = 0;
  linalg::BorderPattern border_;
  std::vector<Scatter> scatter_;
};

}  // namespace sinew::mechanics
