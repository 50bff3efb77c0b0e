/// @file
/// The rows of the world that touch one body, and what it remembers of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::mechanics {

/// Which rows have entries on a body, for one of few coordinates.
struct OwnRows {
  struct Entry {
    int row = 0;    ///< of `rows`
    int entry = 0;  ///< of the world's
    int site = 0;
  };
  /// A row on the body's surface, which has one entry there.
  struct SurfaceEntry {
    std::int32_t row = 0;  ///< of the world's
    int entry = 0;         ///< of the world's
  };
  OwnRows() = default;
  /// @param body position in the world. @param world all rows. @param surface_site -1: none.
  OwnRows(int body, const RowPattern& world, int surface_site = -1);

  std::vector<std::int32_t> rows;  ///< of the world's, ascending; without those on the surface
  std::vector<Entry> entries;
  std::vector<SurfaceEntry> surface;  ///< ascending

  bool empty() const { return rows.empty() && surface.empty(); }
};

/// Efforts of the own rows and directions of their entries, as known last: part of the state, since
/// the next step's matrix looks at them.
struct RowMemory {
  explicit RowMemory(const OwnRows& own);

  void restart();
  std::size_t size() const;
  double* save(double* to) const;          ///< @return behind what was written
  const double* load(const double* from);  ///< @return behind what was read

  VectorX effort;
  std::vector<Vector3> directions;
};

}  // namespace sinew::mechanics
