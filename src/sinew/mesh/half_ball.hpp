/// @file
/// Half a ball over a disc, the end of a swept disc; internal to this folder.
#pragma once

#include <vector>

#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/sweep.hpp"

namespace sinew::mesh {

/// Half a ball of radius 1 about the origin, z >= 0. The first nodes are those of the section of
/// the disc, in its order.
struct HalfBall {
  Points nodes;  ///< (n, 3)
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Hexahedron> hexahedra;
  std::vector<NodeId> outside;  ///< nodes at radius 1
};

/// Makes half a ball. @param rings >= 1, for hexahedra >= 2. @param cells hexahedra over
/// disc_section_of_quadrilaterals(), or tetrahedra over disc_section(). Elements may have either
/// orientation.
HalfBall half_ball(int rings, Cells cells);

}  // namespace sinew::mesh
