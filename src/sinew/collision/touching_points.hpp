/// @file
/// Contact points of two rigid shapes that touch or are about to.
#pragma once

#include <array>

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// A pair of points of two shapes that may touch.
struct TouchingPoint {
  Vector3 on_first = Vector3::Zero(), on_second = Vector3::Zero();  ///< (3,) m
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, from the second towards the first
  double gap = 0.0;  ///< m, normal.(on_first - on_second); negative if they overlap
  int feature = 0;   ///< identifies the parts of the shapes; the same in the next step
};

/// A list of contact points, of fixed capacity.
class TouchingPoints {
 public:
  static constexpr std::size_t kMax = 8;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const TouchingPoint& operator[](std::size_t k) const { return points_[k]; }
  const TouchingPoint* begin() const { return points_.data(); }
  const TouchingPoint* end() const { return points_.data() + size_; }
  void add(const TouchingPoint& point) { points_[size_++] = point; }

 private:
  std::array<TouchingPoint, kMax> points_ = {};
  std::size_t size_ = 0;
};

/// Finds the contact points of two shapes with a gap of at most `margin`, enough of them to support
/// one shape on the other. The smallest gap is the signed distance (see separation()): moving one
/// of two overlapping shapes by it along its normal separates them. No gap is smaller.
///
/// Facets that face each other are clipped, seen along the normal of that distance (C. Ericson,
/// "Real-Time Collision Detection", 2005, section 5.5). This gives the corners of polygons, the
/// ends of lines and four points of a round end, each with the gap of its own two points. Capsules
/// and the sides of cylinders that lie along each other touch at the ends of their common part,
/// with normals of their own. The nearest pair is always included. Of more than eight points, the
/// deepest one and those farthest from each other are kept.
///
/// The four points of a standing end lie in directions given by the other shape (by its sides; for
/// a plane or a round end, by the normal's unitOrthogonal()), so that noise does not turn them. A
/// tilted end also has its lowest point. An inclined capsule is touched through the balls at its
/// ends; the point of the upper one may lie inside it.
///
/// A ConvexSolid can only touch planes, with its corners: the lowest one and those farthest out
/// along the plane. With any other shape: Error(not-in-this-version).
///
/// Two planes have no contact points. Shapes must be checked().
/// @param first,second the two shapes, in their poses.
/// @param margin m; may be negative.
TouchingPoints touching_points(const Shape& first, const Shape& second, double margin);

}  // namespace sinew::collision
