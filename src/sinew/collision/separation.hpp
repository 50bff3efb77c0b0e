/// @file
/// The direction in which two convex solids are farthest apart, or overlap least.
#pragma once

#include "sinew/collision/symmetric_solid.hpp"

namespace sinew::collision {

/// Two solids lie on both sides of a slab, or overlap by it.
struct Separation {
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, from the second towards the first
  double gap = -kInfinity;            ///< m, the slab's thickness; negative where they overlap
  /// (3,) m, a pair of points at that gap.
  Vector3 on_first = Vector3::Zero(), on_second = Vector3::Zero();
};
/// Thickness of the slab normal to `direction`, m: never more than the signed distance, so that the
/// first, moved by -gap along the normal, is free. @param first,second the two solids.
/// @param direction (3,) unit length, from the second towards the first.
double slab(const SymmetricSolid& first, const SymmetricSolid& second, const Vector3& direction);

/// The greatest slab. It is the distance where the solids are apart, found by nearest_cores().
/// Where cores overlap, it is that of the normals of faces and of pairs of edges (S. Gottschalk, M.
/// C. Lin & D. Manocha, SIGGRAPH 1996, section 5), which are all there are for polytopes. A
/// cylinder's rim adds normals between: the best one is turned to that of the distance which the
/// cores would have if they were parted along it, and from there by Newton's method, as long as the
/// slab grows. What is found is a slab in any case; in rare poses, about one in thousands, it is
/// not the greatest.
///
/// The points of overlapping round solids have about half the digits of the gap, and fewer where
/// the overlap is of the solids' own size.
/// @param first,second the two solids.
/// @param margin m: above it only its excess is promised, and no points.
Separation separation(const SymmetricSolid& first, const SymmetricSolid& second, double margin);

}  // namespace sinew::collision
