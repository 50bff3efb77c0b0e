/// @file
/// What touches what in a mesh: faces, surface, used nodes, components.
#pragma once

#include <array>
#include <vector>

#include "sinew/mesh/mesh.hpp"

namespace sinew::mesh {

/// The four faces of a positively oriented tetrahedron, face k opposite node k, each
/// counter-clockwise seen from outside.
std::array<Triangle, 4> faces_of(const Tetrahedron& tetrahedron);

/// The six faces of a positively oriented hexahedron, counter-clockwise seen from outside.
std::array<std::array<NodeId, 4>, 6> faces_of(const Hexahedron& hexahedron);

/// One use of a face by a tetrahedron.
struct FaceUse {
  Triangle key;       ///< node numbers, ascending
  bool even = false;  ///< the outward order is an even permutation of `key`
  int tetrahedron = 0;
};

/// Every face of every tetrahedron, sorted by key, then tetrahedron: uses of one face are adjacent.
std::vector<FaceUse> face_uses(const Mesh& mesh);

/// The surface of the volume elements: faces that belong to one element only, outward. Nodes are
/// those of the mesh, in its numbering, unused ones included. Faces of hexahedra are split in two.
Surface boundary_surface(const Mesh& mesh);

/// For each node whether a volume element uses it.
std::vector<char> used_nodes(const Mesh& mesh);

/// Parts of the mesh: nodes that are joined by elements.
struct Components {
  std::vector<int> of_node;        ///< component of each node; -1 for unused nodes
  std::vector<int> element_count;  ///< elements of each component, largest first
  std::vector<int> node_count;     ///< nodes of each component, in the same order
  std::vector<NodeId> first_node;  ///< lowest node of each component
};

/// Components by shared nodes.
Components components(const Mesh& mesh);

}  // namespace sinew::mesh
