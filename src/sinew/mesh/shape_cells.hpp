/// @file
/// What shapes are made of, with the corners and arcs of round ones; internal to this folder.
#pragma once

#include <functional>
#include <vector>

#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/sweep.hpp"

namespace sinew::mesh {

/// A circle about an axis along z that curves the edges between nodes on it.
struct Circle {
  double x = 0.0;                        ///< of the axis, at y = 0, m
  std::function<double(double)> radius;  ///< at a height, m
};

/// A sphere that curves the edges between nodes on it, as far as they lie on one side of it.
struct Ball {
  double z = 0.0;       ///< of its centre, on the z axis, m
  double radius = 0.0;  ///< m
  double side = 1.0;    ///< 1: from its centre upwards, -1: downwards
};

/// How much farther out than a circle the corners of a regular polygon lie that has its area, which
/// gives it nearly the same second moment as well: bending stiffness is right from few cells on.
/// @param corners,cells of the polygon. Quadratic cells have arcs: 1.
double rounding(int corners, Cells cells);

/// Nodes of a section at its radius 1.
int outside_corners(const Section& section);

/// Renumbers so that every node belongs to an element.
void drop_unused_nodes(Mesh& mesh);

/// The mesh as the cells ask: with middle nodes where they are quadratic, those of edges along a
/// circle or a ball on its arc.
Mesh finished(Mesh mesh, Cells cells, const std::vector<Circle>& circles,
              const std::vector<Ball>& balls = {});

}  // namespace sinew::mesh
