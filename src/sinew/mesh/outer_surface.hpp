/// @file
/// What is drawn of a mesh: its outside, and its elements cut into tetrahedra where it is cut open.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// The triangles of boundary_surface(), its vertices numbered anew.
struct OuterSurface {
  std::vector<NodeId> nodes;             ///< (v,) mesh node of each vertex
  std::vector<std::uint32_t> triangles;  ///< (3 t,) vertices, outward by the right-hand rule
  /// (t,) the element behind each triangle: tetrahedra, then hexahedra; -1 where the mesh has none.
  std::vector<std::int32_t> elements;
};

/// @param mesh of elements, or of triangles alone.
OuterSurface outer_surface(const Mesh& mesh);

/// The elements of a mesh as linear tetrahedra that fill the outer surface without gaps, however
/// the nodes move: a quadratic tetrahedron is eight, with edges through its middle nodes; a
/// hexahedron twelve, from its middle to the triangles of its faces, of which neighbours have the
/// same.
struct Interior {
  std::vector<NodeId> nodes;          ///< (i,) nodes of elements that are not on the surface
  std::vector<Hexahedron> hexahedra;  ///< (h,) whose middles, means of their nodes, are vertices
  /// (4 s,) vertices: those of the outer surface, then `nodes`, then the middles. Positively
  /// oriented at rest.
  std::vector<std::uint32_t> tetrahedra;
  std::vector<std::int32_t> elements;  ///< (s,) that each tetrahedron is of
};

/// Empty for a mesh without elements. @param mesh,surface of one mesh.
Interior interior(const Mesh& mesh, const OuterSurface& surface);

}  // namespace sinew::mesh
