/// @file
/// What touches what in a mesh: faces, surface, used nodes, components.
#pragma once

#include <array>
#include <span>
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

/// A face of a volume element, counter-clockwise seen from outside the element.
struct Face {
  std::array<NodeId, 4> node{-1, -1, -1, -1};  ///< the last one -1 for a triangle
  /// Of a quadratic triangle: between corner k and k + 1.
  std::array<NodeId, 3> middle{-1, -1, -1};
  int corners() const { return node[3] < 0 ? 3 : 4; }
  bool is_quadratic() const { return middle[0] >= 0; }
  std::span<const NodeId> nodes() const {
    return {node.data(), static_cast<std::size_t>(corners())};
  }
};

/// The four flat triangles of a quadratic one, turned as it is: at its corners, then the middle
/// one.
std::array<Triangle, 4> quarters(const Face& face);

/// The faces that belong to one element only: triangles of tetrahedra, then quadrilaterals of
/// hexahedra. Of a mesh without volume elements its triangles.
std::vector<Face> boundary_faces(const Mesh& mesh);

/// The nodes of boundary_faces(), ascending; middles of quadratic faces included.
std::vector<NodeId> outer_nodes(const Mesh& mesh);

/// The triangles that stand for faces: quarters of quadratic ones, quadrilaterals split in two
/// along the shorter diagonal; of two that are as long, that with the corner of the least x, of
/// these the least y, then z. The numbers of nodes and elements decide nothing.
/// @param nodes (n, 3) m. @param faces of these nodes.
std::vector<Triangle> triangles_of(const Points& nodes, std::span<const Face> faces);

/// The surface of the volume elements: triangles_of() boundary_faces(). Nodes are
/// those of the mesh, in its numbering, unused ones included.
Surface boundary_surface(const Mesh& mesh);

/// m, of the longest edge of its triangles.
double longest_edge(const Surface& surface);

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
