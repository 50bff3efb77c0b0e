/// @file
/// Finer meshes of the same body.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Every tetrahedron into eight: four at its corners, and the octahedron between them cut along its
/// shortest diagonal. Old nodes keep their numbers, the middles of edges follow. Elements and
/// triangles keep their sets; the middle of an edge belongs to a node set when both ends do. The
/// shape quality stays bounded under repetition (J. Bey, "Tetrahedral grid refinement", Computing
/// 55, 1995; A. Liu, B. Joe, "Quality local refinement of tetrahedral meshes based on
/// 8-subtetrahedron subdivision", Math. Comp. 65, 1996).
/// @param mesh of tetrahedra. Throws Error(unsupported-element) when it has hexahedra, and
/// Error(size-limit) when there would be more than 2^31 - 1 elements.
Mesh refine(const Mesh& mesh);

}  // namespace sinew::mesh
