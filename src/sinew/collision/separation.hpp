/// @file
/// The direction in which two convex solids have the largest distance, or the smallest overlap.
#pragma once

#include "sinew/collision/symmetric_solid.hpp"

namespace sinew::collision {

/// The slab between two solids, or the one by which they overlap.
struct Separation {
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, from the second towards the first
  double gap = -kInfinity;            ///< m, the slab's thickness; negative where they overlap
  /// A pair of points at that gap, (3,) m.
  Vector3 on_first = Vector3::Zero(), on_second = Vector3::Zero();
};
/// Thickness of the slab normal to `direction`, m. It never exceeds the signed distance; moving the
/// first by -gap along the normal therefore separates the solids. @param first,second the two
/// solids.
/// @param direction (3,) unit length, from the second towards the first.
double slab(const SymmetricSolid& first, const SymmetricSolid& second, const Vector3& direction);

/// The thickest slab. For separate solids it is the distance, found by nearest_cores(). For
/// overlapping cores, the candidates are the normals of faces and of pairs of edges (S. Gottschalk,
/// M. C. Lin & D. Manocha, SIGGRAPH 1996, section 5), which suffice for polytopes. The rim of a
/// cylinder adds intermediate normals. The best normal is turned to that of the distance which the
/// cores would have if they were moved apart along it, and then improved by Newton's method, as
/// long as the slab grows. The result is always a slab; in rare poses, about one in thousands, it
/// is not the thickest.
///
/// The points of overlapping round solids have about half the digits of the gap, and fewer if the
/// overlap is of the solids' own size.
/// @param first,second the two solids.
/// @param margin m: for a larger gap, the result is only guaranteed to exceed it and has no points.
Separation separation(const SymmetricSolid& first, const SymmetricSolid& second, double margin);

}  // namespace sinew::collision
