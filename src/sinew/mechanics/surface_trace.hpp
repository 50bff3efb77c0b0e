/// @file
/// What moves a point of a body's surface.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/collision/proximity.hpp"
#include "sinew/collision/surface_topology.hpp"
#include "sinew/mechanics/rows.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mechanics {

/// The shape functions of the faces that a surface's triangles stand for. A quadrilateral is
/// bilinear on both of its triangles, so that forces at the corners of what two faces have in
/// common can be those of a uniform pressure on both. Quadratic faces are taken as their four flat
/// triangles: with quadratic functions errors halve, but dense contacts of many points were no
/// longer solved.
class SurfaceTrace {
 public:
  /// Linear on every triangle.
  SurfaceTrace() = default;
  /// @param faces of the surface. @param node_count of the mesh.
  SurfaceTrace(std::span<const mesh::Face> faces, int node_count);

  /// @param place on a vertex, an edge or a triangle of the surface's triangles.
  Patch at(const collision::SurfacePoint& place) const;

 private:
  using Quadrilateral = std::array<NodeId, 4>;
  static Patch on(const Quadrilateral& face, const collision::SurfacePoint& place);

  std::vector<Quadrilateral> faces_;
  collision::NumberLists faces_of_node_;
};

}  // namespace sinew::mechanics
