/// @file
/// The segment in which two triangles cross, with its direction.
#pragma once

#include <array>
#include <optional>

#include "sinew/collision/surface_topology.hpp"
#include "sinew/collision/triangle_intersection.hpp"

namespace sinew::collision {

/// A triangle of a surface: corners, and their nodes, by which edges are told apart.
struct SurfaceTriangle {
  Corners corners;
  Triangle nodes;
};

/// A place in a triangle: x_0 + u (x_1 - x_0) + v (x_2 - x_0) is (u, v).
using Place2 = Eigen::Vector2d;

/// Where the edge from corner 1 to corner 2 passes the other triangle.
struct EdgePass {
  Place2 place = Place2::Zero();
  int sign = 0;  ///< 1: to the inner side of the other triangle; -1: out; 0: it does not pass
};

/// A triangle's part in the cut.
struct CutSide {
  Place2 from = Place2::Zero(), to = Place2::Zero();  ///< inside of the other surface on the left
  EdgePass pass;
};

/// The cut of two triangles as each sees it; the directions are opposite.
struct TriangleCut {
  std::array<CutSide, 2> sides;
};

/// Nothing where no edge of one passes the other. All signs are exact; the places are rounded, the
/// same for triangles that share an edge. A sign of zero counts as positive for an edge and a
/// triangle or two edges in the order of their nodes, whatever triangle they are seen from.
/// @param first,second of two surfaces.
std::optional<TriangleCut> cut(const SurfaceTriangle& first, const SurfaceTriangle& second);

}  // namespace sinew::collision
