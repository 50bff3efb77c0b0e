/// @file
/// Position of a point relative to a triangle surface.
#pragma once

#include <functional>

#include "sinew/collision/surface_tree.hpp"

namespace sinew::collision {

/// The point of a surface nearest to another point.
struct NearestOnSurface {
  int triangle = -1;  ///< the first of those at that distance; -1: none within reach
  Vector3 weights = Vector3::Zero();  ///< (3,) of its corners
  Vector3 point = Vector3::Zero();    ///< (3,) m
  double distance = kInfinity;        ///< m
};
/// Finds the nearest point of a surface. @param surface at its last moved position.
/// @param point (3,) m. @param reach m: farther points are not searched.
/// @param skips triangles to omit; empty: none.
NearestOnSurface nearest_on_surface(const SurfaceTree& surface, const Vector3& point,
                                    double reach = kInfinity,
                                    const std::function<bool(int)>& skips = {});

/// Winding number of a closed surface around a point: 0 outside, 1 inside, more where the surface
/// overlaps itself, negative inside an inverted one. It is computed exactly from the signed
/// crossings of a ray along +x (orientation.hpp), with half-open edges, so that a ray through an
/// edge or a vertex counts once. On the surface it is that of one of the two sides.
/// @param surface closed, at its last moved position. @param point (3,) m.
int winding_number(const SurfaceTree& surface, const Vector3& point);

}  // namespace sinew::collision
