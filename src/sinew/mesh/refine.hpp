/// @file
/// Uniform refinement of meshes.
#pragma once

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Splits every tetrahedron into eight: four at its corners, and the octahedron between them, cut
/// along its shortest diagonal. Old nodes keep their numbers; the middles of edges follow. Elements
/// and triangles stay in their sets; the middle of an edge belongs to a node set if both ends do.
/// The shape quality stays bounded under repeated refinement (J. Bey, "Tetrahedral grid
/// refinement", Computing 55, 1995; A. Liu, B. Joe, "Quality local refinement of tetrahedral meshes
/// based on 8-subtetrahedron subdivision", Math. Comp. 65, 1996).
/// @param mesh of linear tetrahedra. Throws Error(unsupported-element) for hexahedra and quadratic
///   tetrahedra, and Error(size-limit) beyond 2^31 - 1 elements.
Mesh refine(const Mesh& mesh);

}  // namespace sinew::mesh
