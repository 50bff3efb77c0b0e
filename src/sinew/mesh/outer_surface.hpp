/// @file
/// Geometry for drawing a mesh: its outer surface, and its elements as tetrahedra for cut views.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// The triangles of boundary_surface(), with their own numbering of vertices.
struct OuterSurface {
  std::vector<NodeId> nodes;             ///< (v,) mesh node of each vertex
  std::vector<std::uint32_t> triangles;  ///< (3 t,) vertices, outward by the right-hand rule
  /// (t,) the element of each triangle: tetrahedra, then hexahedra; -1 if the mesh has none.
  std::vector<std::int32_t> elements;
};

/// Makes the outer surface. @param mesh of elements, or of triangles only.
OuterSurface outer_surface(const Mesh& mesh);

/// The elements of a mesh as linear tetrahedra, which fill the outer surface without gaps however
/// the nodes move. A quadratic tetrahedron is split into eight, with edges through its middle
/// nodes. A hexahedron is split into twelve, from its middle to the triangles of its faces, which
/// are the same for both neighbours of a face.
struct Interior {
  std::vector<NodeId> nodes;          ///< (i,) nodes of elements that are not on the surface
  std::vector<Hexahedron> hexahedra;  ///< (h,) whose middles (means of their nodes) are vertices
  /// (4 s,) vertex numbers: first the outer surface, then `nodes`, then the middles. Positively
  /// oriented at rest.
  std::vector<std::uint32_t> tetrahedra;
  std::vector<std::int32_t> elements;  ///< (s,) the element of each tetrahedron
};

/// Makes the interior; empty for a mesh without elements. @param mesh,surface a mesh and its outer
/// surface.
Interior interior(const Mesh& mesh, const OuterSurface& surface);

}  // namespace sinew::mesh
