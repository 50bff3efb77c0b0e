/// @file
/// Interpolation of nodes at points of the surface of a body.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_topology.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mechanics {

/// Shape functions of the faces to which the triangles of a surface belong. A quadrilateral is
/// bilinear on both of its triangles, so that forces at the corners of the overlap of two faces can
/// represent a uniform pressure on both. Quadratic faces are treated as four flat triangles:
/// quadratic functions halve the errors, but with them dense contacts of many points no longer
/// converged.
class SurfaceTrace {
 public:
  /// Linear on every triangle.
  SurfaceTrace() = default;
  /// @param faces of the surface. @param node_count of the mesh.
  SurfaceTrace(std::span<const mesh::Face> faces, int node_count);

  /// Nodes and weights of a point of the surface. @param place on a vertex, an edge or a triangle.
  Patch at(const collision::SurfacePoint& place) const;

 private:
  using Quadrilateral = std::array<NodeId, 4>;
  static Patch on(const Quadrilateral& face, const collision::SurfacePoint& place);

  std::vector<Quadrilateral> faces_;
  collision::NumberLists faces_of_node_;
};

}  // namespace sinew::mechanics
