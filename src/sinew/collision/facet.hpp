/// @file
/// Flat parts and straight lines of a shape's surface that face another shape.
#pragma once

#include <array>

#include "sinew/collision/symmetric_solid.hpp"

namespace sinew::collision {

/// A piece of surface, seen along a direction.
struct Facet {
  enum class Kind { half_space, polygon, disc, line };
  Kind kind = Kind::half_space;
  Vector3 centre = Vector3::Zero();     ///< (3,) m, on it
  Vector3 normal = Vector3::Zero();     ///< (3,) unit length; of a line none
  std::array<Vector3, 4> corners = {};  ///< (3,) m, round the polygon; a line's ends
  std::array<int, 4> names = {};        ///< of the corners, below 8, the same for all facets
  std::size_t corner_count = 0;
  double radius = 0.0;  ///< m, of the disc
  int face = 0;         ///< of a box, the polygon's number, below 6
  int end = 0;          ///< of the cylinder that the disc is at: 0 or 1

  bool flat() const { return kind != Kind::line; }
  /// (3,) m: the point of the facet's plane on a line. @param point (3,) m. @param direction (3,).
  Vector3 cast(const Vector3& point, const Vector3& direction) const;
};

/// The facets of a solid that face a direction, at most a box's three.
class Facets {
 public:
  /// Of a box its faces; of a cylinder an end and the line of its side that is farthest out; of a
  /// capsule that line; of a sphere none. @param solid of such a shape.
  /// @param direction (3,) unit length.
  Facets(const SymmetricSolid& solid, const Vector3& direction);
  explicit Facets(const Plane& plane);

  const Facet* begin() const { return facets_.data(); }
  const Facet* end() const { return facets_.data() + count_; }

 private:
  void add_faces(const SymmetricSolid& solid, const Vector3& local);
  void add_line(const SymmetricSolid& solid, const Vector3& direction);
  Facet& add() { return facets_[count_++]; }

  std::array<Facet, 3> facets_;
  std::size_t count_ = 0;
};

/// The part of a straight way that is over a facet.
struct Clipped {
  bool any = false;
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  ///< (3,) m
  /// What cuts off the rest: a polygon's side, from the corner of that number, or a rim, 0; -1 for
  /// an end of the way.
  int from_cut = -1, to_cut = -1;
};
/// Looks along a direction: what is kept has a point of the facet before or behind it.
/// @param from,to (3,) m. @param facet a flat one. @param direction (3,) unit length.
/// @param slack m: what is less far outside counts as inside. A way that only touches the facet's
///   border is not over it: by rounding it might as well miss it.
Clipped clip(const Vector3& from, const Vector3& to, const Facet& facet, const Vector3& direction,
             double slack);

}  // namespace sinew::collision
