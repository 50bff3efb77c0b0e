/// @file
/// Intersections of a straight line with the faces of a mesh.
#pragma once

#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Fractions of the line between two points at which it meets faces of elements. Between two of
/// them, the line stays in one element, or outside. Faces of hexahedra are bilinear; quadratic
/// tetrahedra count as their flat corner tetrahedra, as in the Embedder. A line within a face is
/// cut at the edges of the face.
/// @param mesh at rest. @param from,to (3,) m, at rest.
/// @return ascending, from 0 to 1, including both.
std::vector<double> line_cuts(const Mesh& mesh, const Vector3& from, const Vector3& to);

}  // namespace sinew::mesh
