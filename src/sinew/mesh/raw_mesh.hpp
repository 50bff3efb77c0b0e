/// @file
/// What a mesh file holds before anything is made of it: the common ground of all readers.
#pragma once

#include <cstdint>
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

/// An integer value for each point or cell.
struct IntegerField {
  std::string name;
  bool mask = false;  ///< stored in 8 bits: 0/1 values then mean "in the set called `name`"
  std::vector<std::int64_t> values;
};

/// A group of cells that the file names itself (Gmsh's physical groups).
struct CellGroup {
  std::string name;
  std::vector<std::size_t> cells;
};

/// Points and cells as the file gives them, unchecked. Cell c has the points
/// `connectivity[offsets[c] .. offsets[c + 1])`, numbered from 0.
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

/// Sorts the cells by type, checks every index and makes the named sets. Integer fields become sets
/// `name:value` for each value, or the one set `name` when they are 8-bit masks; fields with more
/// than 256 values are labels of something else and are passed over. Lengths stay in file units.
/// Throws Error(index-out-of-range, unsupported-element, malformed-file, size-limit).
Mesh assemble(const RawMesh& raw);

/// "tetrahedron", "pyramid" or "type 42".
std::string cell_type_name(std::int64_t type);

}  // namespace sinew::mesh
