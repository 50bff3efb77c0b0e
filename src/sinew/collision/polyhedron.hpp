/// @file
/// Convex polyhedra: the hull of points.
#pragma once

#include <array>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::collision {

/// A solid convex polyhedron. Immutable.
class Polyhedron {
 public:
  /// A triangle of the surface; coplanar triangles together form a face.
  struct Face {
    std::array<Vector3, 3> corners;     ///< (3,) m, counter-clockwise seen from outside
    Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, outwards
    double offset = 0.0;                ///< m: normal.x on the plane
  };

  /// Computes the convex hull (Barber, Dobkin & Huhdanpaa, The Quickhull algorithm for convex
  /// hulls, ACM Trans. Math. Software 22, 1996, 469; by the authors' Qhull). Throws Error:
  /// zero-volume for points that span no volume. @param points (n, 3) m, finite.
  explicit Polyhedron(const Points& points);

  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<Vector3>& corners() const { return corners_; }  ///< (3,) m each
  /// An upper bound of the corners' distance from the origin, m.
  double reach() const { return reach_; }

 private:
  std::vector<Face> faces_;
  std::vector<Vector3> corners_;
  double reach_ = 0.0;
};

}  // namespace sinew::collision
