/// @file
/// Points at which two rigid shapes touch, or are about to.
#pragma once

#include <array>

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// A pair of points of two shapes that may touch.
struct TouchingPoint {
  Vector3 on_first = Vector3::Zero(), on_second = Vector3::Zero();  ///< (3,) m
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, from the second towards the first
  double gap = 0.0;                   ///< m, normal.(on_first - on_second); negative: they overlap
  int feature = 0;  ///< which parts of the shapes made it; the same in the next step
};

/// A list of fixed capacity.
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

/// The pairs of points of two shapes with a gap of at most `margin`, enough of them to hold one
/// shape on the other. The least gap is the signed distance (see separation()): moved by it along
/// its normal, shapes that overlap are free. No gap is less.
///
/// Looking along the normal of that distance, facets that face each other are clipped (C. Ericson,
/// "Real-Time Collision Detection", 2005, section 5.5): corners of a polygon, ends of lines and
/// four points of a round end, each with the gap of its own two points. Capsules and the sides of
/// cylinders that lie along each other touch at the ends of what they share, with normals of their
/// own. The nearest pair is always there. Of more than eight, the deepest one stays and those
/// farthest from each other.
///
/// The four points of a standing end are in directions that the other shape gives (its sides; of a
/// plane or a round end the normal's unitOrthogonal()), so that noise does not turn them. A tilted
/// end has its lowest point, too. A capsule that leans is touched through the balls at its ends:
/// the upper one's point may be in it.
///
/// A ConvexSolid is touched by planes alone, at its corners: the lowest one and those farthest out
/// along the plane. With any other shape: Error(not-in-this-version).
///
/// Two planes have no points. Shapes are taken to be checked().
/// @param first,second the two shapes, where they are.
/// @param margin m; also a negative one.
TouchingPoints touching_points(const Shape& first, const Shape& second, double margin);

}  // namespace sinew::collision
