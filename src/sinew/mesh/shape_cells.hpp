/// @file
/// Cells of generated shapes, and corners and arcs of round ones; internal to this folder.
#pragma once

#include <functional>
#include <vector>

#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/sweep.hpp"

namespace sinew::mesh {

/// Circles about an axis along z. Edges between nodes on one become arcs.
struct Circle {
  double x = 0.0;                        ///< x of the axis, which is at y = 0, m
  std::function<double(double)> radius;  ///< radius at a height, m
};

/// Half a sphere. Edges between nodes on it become arcs.
struct Ball {
  double z = 0.0;       ///< z of its centre, on the z axis, m
  double radius = 0.0;  ///< m
  double side = 1.0;    ///< 1: the half above the centre, -1: the half below
};

/// Ratio of the circumradius of a regular polygon to the radius of the circle of the same area.
/// Such a polygon has nearly the same second moment, too, so that a few cells give the right
/// bending stiffness.
/// @param corners,cells of the polygon. The ratio is 1 for quadratic cells, which have arcs.
double rounding(int corners, Cells cells);

/// Number of nodes of a section at radius 1.
int outside_corners(const Section& section);

/// Removes nodes without elements, and renumbers the others.
void drop_unused_nodes(Mesh& mesh);

/// Completes a mesh for the kind of cells: adds middle nodes if they are quadratic, and moves those
/// of edges along a circle or ball onto the arc. Elements that an arc would fold keep straight
/// edges.
Mesh finished(Mesh mesh, Cells cells, const std::vector<Circle>& circles,
              const std::vector<Ball>& balls = {});

}  // namespace sinew::mesh
