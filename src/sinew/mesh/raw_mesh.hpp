/// @file
/// Unchecked content of a mesh file, the common output of all readers.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Cell types by the numbers that VTK files use (vtkCellType.h).
enum CellType : int {
  kVertex = 1,
  kLine = 3,
  kTriangle = 5,
  kQuadrilateral = 9,
  kTetrahedron = 10,
  kVoxel = 11,
  kHexahedron = 12,
  kWedge = 13,
  kPyramid = 14,
  kQuadraticTetrahedron = 24,
  kQuadraticHexahedron = 25,
};

/// Value of a point or cell without a value in the file. It belongs to no set.
inline constexpr std::int64_t kNoLabel = std::numeric_limits<std::int64_t>::min();

/// An integer value for each point or cell.
struct IntegerField {
  std::string name;
  bool mask = false;  ///< stored in 8 bits: values 0 and 1 are a mask of the set `name`
  std::vector<std::int64_t> values;
};

/// A named group of cells in the file (a physical group of Gmsh).
struct CellGroup {
  std::string name;
  std::vector<std::size_t> cells;
};

/// Points and cells of the file, unchecked. The points of cell c are those of `connectivity` at
/// offsets[c] .. offsets[c + 1] - 1, numbered from 0.
struct RawMesh {
  std::string name;
  std::string format;
  std::vector<double> coordinates;  ///< (3 n,) file units: x0 y0 z0 x1 ...
  std::vector<std::int64_t> offsets{0};
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> types;  ///< CellType
  std::vector<IntegerField> point_fields;
  std::vector<IntegerField> cell_fields;
  std::vector<CellGroup> groups;

  std::size_t point_count() const { return coordinates.size() / 3; }
  std::size_t cell_count() const { return types.size(); }

  /// Appends one cell.
  void add_cell(int type, const std::int64_t* points, std::size_t count) {
    connectivity.insert(connectivity.end(), points, points + count);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
  }
};

/// Makes a Mesh: sorts the cells by type, checks every index and makes the named sets. An integer
/// field gives a set `name:value` for each value, or one set `name` if it is an 8-bit mask. Fields
/// with more than 256 values are ignored, since they label something else. Lengths stay in file
/// units. Throws Error(index-out-of-range, unsupported-element, malformed-file, size-limit).
Mesh assemble(const RawMesh& raw);

/// Name of a cell type, such as "tetrahedron", "pyramid" or "type 42".
std::string cell_type_name(std::int64_t type);

}  // namespace sinew::mesh
