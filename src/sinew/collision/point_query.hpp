/// @file
/// Where a point stands with respect to a triangle surface.
#pragma once

#include <functional>

#include "sinew/collision/surface_tree.hpp"

namespace sinew::collision {

/// The point of a surface nearest to another point.
struct NearestOnSurface {
  int triangle = -1;                  ///< the lowest of those at that distance; -1: none in reach
  Vector3 weights = Vector3::Zero();  ///< (3,) of its corners
  Vector3 point = Vector3::Zero();    ///< (3,) m
  double distance = kInfinity;        ///< m
};
/// @param surface as it was moved last. @param point (3,) m. @param reach m: farther ones are not
///   looked for. @param skips triangles that are not looked at; none: all are.
NearestOnSurface nearest_on_surface(const SurfaceTree& surface, const Vector3& point,
                                    double reach = kInfinity,
                                    const std::function<bool(int)>& skips = {});

/// How often a closed surface winds round a point: 0 outside, 1 inside, more where it overlaps
/// itself, negative inside one that is turned inside out. Counted exactly as the signed crossings
/// of a ray along +x (orientation.hpp), with half-open edges, so that a ray through an edge or a
/// vertex counts once. On the surface it is that of one of its sides.
/// @param surface closed, as it was moved last. @param point (3,) m.
int winding_number(const SurfaceTree& surface, const Vector3& point);

}  // namespace sinew::collision
