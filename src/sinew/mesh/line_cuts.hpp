/// @file
/// Where a straight line passes from one element of a mesh into the next.
#pragma once

#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// Shares of the way from one point to another at which the line between them meets faces of
/// elements: between two of them it stays in one element, or in none. Faces of hexahedra are
/// bilinear; those of quadratic tetrahedra are taken as those of their corners, as the Embedder
/// takes them. A line within a face is cut where it meets the face's edges.
/// @param mesh at rest. @param from,to (3,) m, at rest.
/// @return ascending, from 0 to 1, both included.
std::vector<double> line_cuts(const Mesh& mesh, const Vector3& from, const Vector3& to);

}  // namespace sinew::mesh
