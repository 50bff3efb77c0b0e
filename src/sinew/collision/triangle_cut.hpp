/// @file
/// The directed segment in which two triangles cross.
#pragma once

#include <array>
#include <optional>

#include "sinew/collision/surface_topology.hpp"
#include "sinew/collision/triangle_intersection.hpp"

namespace sinew::collision {

/// A triangle of a surface: its corners, and their nodes, which identify edges.
struct SurfaceTriangle {
  Corners corners;
  Triangle nodes;
};

/// Coordinates in a triangle: (u, v) is the point x_0 + u (x_1 - x_0) + v (x_2 - x_0).
using Place2 = Eigen::Vector2d;

/// Where the edge from corner 1 to corner 2 passes through the other triangle.
struct EdgePass {
  Place2 place = Place2::Zero();
  int sign = 0;  ///< 1: inwards through the other triangle; -1: outwards; 0: it does not pass
};

/// The cut as one triangle sees it.
struct CutSide {
  Place2 from = Place2::Zero(), to = Place2::Zero();  ///< inside of the other surface on the left
  EdgePass pass;
};

/// The cut as each of two triangles sees it, in opposite directions.
struct TriangleCut {
  std::array<CutSide, 2> sides;
};

/// The cut of two triangles; nothing if no edge of one passes through the other. All signs are
/// exact. The coordinates are rounded, identically for triangles that share an edge. Zero signs are
/// resolved as positive for an edge and a triangle, or for two edges in the order of their nodes,
/// independently of the triangle from which they are seen.
/// @param first,second of two surfaces.
std::optional<TriangleCut> cut(const SurfaceTriangle& first, const SurfaceTriangle& second);

}  // namespace sinew::collision
