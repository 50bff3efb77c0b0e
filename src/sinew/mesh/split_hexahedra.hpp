/// @file
/// Hexahedra as tetrahedra.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Splits every hexahedron into six tetrahedra, which follow those of the mesh: pyramids from its
/// lowest-numbered corner over the three faces without it, each split along the diagonal through
/// its own lowest-numbered corner. Neighbours thus split their common face alike (Dompierre, Labbe,
/// Vallet, Camarero, "How to subdivide pyramids, prisms and hexahedra into tetrahedra", 8th
/// International Meshing Roundtable, 1999). Nodes and their sets are unchanged; sets of elements
/// are dropped.
/// @param mesh of linear elements.
Mesh split_hexahedra(const Mesh& mesh);

}  // namespace sinew::mesh
