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

/// How much farther out than a circle the corners of a regular polygon lie that has its area, which
/// gives it nearly the same second moment as well: bending stiffness is right from few cells on.
/// @param corners,cells of the polygon. Quadratic cells have arcs: 1.
double rounding(int corners, Cells cells);

/// Nodes of a section at its radius 1.
int outside_corners(const Section& section);

/// The mesh as the cells ask: with middle nodes where they are quadratic, those of edges along a
/// circle on its arc.
Mesh finished(Mesh mesh, Cells cells, const std::vector<Circle>& circles);

}  // namespace sinew::mesh
