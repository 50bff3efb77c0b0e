/// @file
/// The rows of the world that touch one body, and their last known values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/mechanics/rows.hpp"

namespace sinew::mechanics {

/// The rows that touch one body with few coordinates, and their entries on it.
struct OwnRows {
  struct Entry {
    int row = 0;    ///< in `rows`
    int entry = 0;  ///< in the world
    int site = 0;
  };
  /// A row on the surface of the body, which has one entry there.
  struct SurfaceEntry {
    std::int32_t row = 0;  ///< in the world
    int entry = 0;         ///< in the world
  };
  OwnRows() = default;
  /// @param body position in the world. @param world all rows. @param surface_site -1 if none.
  OwnRows(int body, const RowPattern& world, int surface_site = -1);

  std::vector<std::int32_t> rows;  ///< numbers in the world, ascending; without surface rows
  std::vector<Entry> entries;
  std::vector<SurfaceEntry> surface;  ///< ascending

  bool empty() const { return rows.empty() && surface.empty(); }
};

/// Last known efforts of the own rows, and directions of their entries. They are part of the state,
/// since the matrix of the next step depends on them.
struct RowMemory {
  explicit RowMemory(const OwnRows& own);

  void restart();
  std::size_t size() const;
  double* save(double* to) const;          ///< @return end of the written values
  const double* load(const double* from);  ///< @return end of the values read

  VectorX effort;
  std::vector<Vector3> directions;
};

}  // namespace sinew::mechanics
