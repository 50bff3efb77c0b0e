/// @file
/// What can be wrong with a mesh, found before anything is computed with it.
#pragma once

#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// What check() lets pass.
struct CheckOptions {
  bool allow_several_components = false;  ///< parts that nothing joins
  bool unit_given = false;                ///< someone chose the unit: any size is believed
  double largest_size = 10.0;             ///< m; a larger mesh without a unit is suspicious
  double smallest_volume = 1e-7;          ///< least |volume| / longest edge^3; regular: 0.118
};

/// One thing wrong, ready to be thrown or listed.
struct Defect {
  ErrorKind kind = ErrorKind::internal;
  std::string message;  ///< what, with element and node numbers (from 0) and values
  std::string remedy;
};

/// Turns elements of negative volume to the positive ordering (see Tetrahedron): files follow one
/// convention or the other, some both, which is no defect. Elements that really lie inside out are
/// found afterwards by find_defects(), since they then overlap a neighbour. Returns how many were
/// turned, and adds that to `mesh.notes`. Node numbers must be in range.
int reorder_elements(Mesh& mesh);

/// Everything wrong with a mesh whose elements were reordered; at most one entry of each kind, with
/// how many there are. Kinds: no-volume-elements, index-out-of-range, non-finite-node,
/// suspicious-unit, repeated-node-in-element, duplicate-node, zero-volume, inverted-element (two
/// elements on the same side of a face that they share, or a hexahedron that is turned inside out
/// at a corner), unsupported-element (a hexahedron's face that meets those of tetrahedra),
/// disconnected-mesh. Defects of numbering and numbers hide those of geometry.
std::vector<Defect> find_defects(const Mesh& mesh, const CheckOptions& options = {});

/// reorder_elements(), then throws the first of find_defects() as Error at `mesh.name`.
void check(Mesh& mesh, const CheckOptions& options = {});

}  // namespace sinew::mesh
