/// @file
/// Checks of a mesh before it is used.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Largest sensible coordinate, m. Beyond it, volumes and products of lengths lose all digits or
/// overflow.
inline constexpr double kFarthestNode = 1e12;

/// What check() accepts.
struct CheckOptions {
  bool allow_several_components = false;  ///< accept disconnected parts
  bool unit_given = false;                ///< the user gave the unit: accept any size
  double largest_size = 10.0;             ///< m; a larger mesh without a unit is suspicious
  double smallest_volume = 1e-7;          ///< minimum of |volume| / longest edge^3; regular: 0.118
};

/// A defect of a mesh, with the parts of an Error.
struct Defect {
  ErrorKind kind = ErrorKind::internal;
  std::string message;  ///< description, with element and node numbers (from 0) and values
  std::string remedy;
};

/// Reorders the nodes of elements with negative volume (see Tetrahedron). Files follow either
/// convention, or both, which is no defect. Elements that are really inverted then overlap a
/// neighbour, and find_defects() finds them. Returns the number of reordered elements, and adds it
/// to `mesh.notes`. Node numbers must be in range.
int reorder_elements(Mesh& mesh);

/// Finds the defects of a mesh after reorder_elements(): one entry per check, for the first fault,
/// with the number of faults. Kinds: no-volume-elements, index-out-of-range, non-finite-node (also
/// beyond kFarthestNode), suspicious-unit, repeated-node-in-element, duplicate-node, zero-volume,
/// inverted-element (two elements on the same side of a common face, or a hexahedron inverted at a
/// corner), unsupported-element (a face of a hexahedron that meets faces of tetrahedra),
/// disconnected-mesh. If one of the first three is found, the others are not checked.
std::vector<Defect> find_defects(const Mesh& mesh, const CheckOptions& options = {});

/// Calls reorder_elements(), then throws the first result of find_defects() as Error at
/// `mesh.name`.
void check(Mesh& mesh, const CheckOptions& options = {});

}  // namespace sinew::mesh
