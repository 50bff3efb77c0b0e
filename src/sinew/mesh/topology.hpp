/// @file
/// Topology of a mesh: faces, surface, used nodes and components.
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

/// All faces of all tetrahedra, sorted by key and then tetrahedron, so that the uses of a face are
/// adjacent.
std::vector<FaceUse> face_uses(const Mesh& mesh);

/// A face of a volume element, counter-clockwise seen from outside the element.
struct Face {
  std::array<NodeId, 4> node{-1, -1, -1, -1};  ///< corners; the last one is -1 for a triangle
  /// Middle nodes of a quadratic triangle, between corners k and k + 1.
  std::array<NodeId, 3> middle{-1, -1, -1};
  int corners() const { return node[3] < 0 ? 3 : 4; }
  bool is_quadratic() const { return middle[0] >= 0; }
  std::span<const NodeId> nodes() const {
    return {node.data(), static_cast<std::size_t>(corners())};
  }
};

/// Splits a quadratic triangle into four flat ones of the same orientation: three at its corners,
/// then the middle one.
std::array<Triangle, 4> quarters(const Face& face);

/// The faces that belong to one element only: triangles of tetrahedra, then quadrilaterals of
/// hexahedra. For a mesh without volume elements, its triangles.
std::vector<Face> boundary_faces(const Mesh& mesh);

/// The nodes of boundary_faces(), ascending, including middle nodes of quadratic faces.
std::vector<NodeId> outer_nodes(const Mesh& mesh);

/// Splits faces into triangles: quadratic triangles by quarters(), quadrilaterals along the shorter
/// diagonal. If both diagonals are equal, the one with the corner of the smallest x is used, then
/// y, then z, along the given axes. The result does not depend on node and element numbers and,
/// with the axes of the mesh, not on its position and rotation.
/// @param nodes (n, 3) m. @param axes see Mesh::axes. @param faces of these nodes.
std::vector<Triangle> triangles_of(const Points& nodes, const Matrix3& axes,
                                   std::span<const Face> faces);
/// The same for faces of a mesh.
std::vector<Triangle> triangles_of(const Mesh& mesh, std::span<const Face> faces);

/// The surface of the volume elements: triangles_of() the boundary_faces(). It has all nodes of the
/// mesh, in the same numbering, including unused ones.
Surface boundary_surface(const Mesh& mesh);

/// Length of the longest edge of the triangles, m.
double longest_edge(const Surface& surface);

/// (n,) whether a volume element uses each node.
std::vector<char> used_nodes(const Mesh& mesh);

/// Connected components of a mesh.
struct Components {
  std::vector<int> of_node;        ///< component of each node; -1 for unused nodes
  std::vector<int> element_count;  ///< number of elements of each component, descending
  std::vector<int> node_count;     ///< number of nodes of each component
  std::vector<NodeId> first_node;  ///< lowest node of each component
};

/// Finds the components of a mesh; elements with a common node are connected.
Components components(const Mesh& mesh);

}  // namespace sinew::mesh
