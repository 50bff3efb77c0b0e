/// @file
/// Facets of a shape: flat parts and straight lines of its surface that face another shape.
#pragma once

#include <array>

#include "sinew/collision/symmetric_solid.hpp"

namespace sinew::collision {

/// A flat part or straight line of a surface.
struct Facet {
  enum class Kind { half_space, polygon, disc, line };
  Kind kind = Kind::half_space;
  Vector3 centre = Vector3::Zero();     ///< (3,) m, on the facet
  Vector3 normal = Vector3::Zero();     ///< (3,) unit length; zero for a line
  std::array<Vector3, 4> corners = {};  ///< (3,) m, in order around a polygon; the ends of a line
  std::array<int, 4> names = {};        ///< names of the corners, below 8, the same in all facets
  std::size_t corner_count = 0;
  double radius = 0.0;  ///< m, of a disc
  int face = 0;         ///< number of a polygon on its box, below 6
  int end = 0;          ///< end of the cylinder at which a disc lies: 0 or 1

  bool flat() const { return kind != Kind::line; }
  /// The intersection of the facet's plane with a line, (3,) m. @param point (3,) m.
  /// @param direction (3,).
  Vector3 cast(const Vector3& point, const Vector3& direction) const;
};

/// The facets of a solid that face a direction, at most a box's three.
class Facets {
 public:
  /// A box has faces; a cylinder an end and the outermost line of its side; a capsule that line; a
  /// sphere no facets. @param solid the shape, in this form.
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

/// The part of a segment that lies over a facet.
struct Clipped {
  bool any = false;
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  ///< (3,) m
  /// What cuts off the rest: the number of a polygon's side, which is that of its first corner; 0
  /// for a rim; -1 for an end of the segment.
  int from_cut = -1, to_cut = -1;
};
/// Clips a segment against a facet, seen along a direction: the part that is kept has a point of
/// the facet before or behind it. @param from,to (3,) m. @param facet a flat one.
/// @param direction (3,) unit length.
/// @param slack m: what is less far outside counts as inside. A segment that only touches the
///   border of the facet is not over it, since rounding decides whether it touches or misses.
Clipped clip(const Vector3& from, const Vector3& to, const Facet& facet, const Vector3& direction,
             double slack);

}  // namespace sinew::collision
