/// @file
/// Parts of rigid shapes that touch, and where two of them touch as the shapes move.
#pragma once

#include <Eigen/Geometry>

#include "sinew/collision/shape.hpp"

namespace sinew::collision {

/// The part of a shape at one of its contact points.
struct TouchingFeature {
  enum class Kind {
    point,   ///< a ball, or a corner (radius 0)
    line,    ///< the side of a capsule or cylinder, or an edge (radius 0)
    circle,  ///< the rim of a cylinder
    face,    ///< a flat part
  };
  Kind kind = Kind::point;
  /// (3,) m: the centre of the ball, a point on the line's axis, the centre of the circle, a point
  /// on the face.
  Vector3 at = Vector3::Zero();
  Vector3 axis = Vector3::Zero();  ///< (3,) unit length, of a line or circle; a face's normal
  double radius = 0.0;             ///< m, of the ball, the line or the circle

  /// The feature, moved with its shape.
  TouchingFeature moved(const Eigen::Isometry3d& pose) const;
};

/// The feature of a shape at a contact point. A standing cylinder touches with points of its rim,
/// which are corners.
/// @param shape of any kind. @param on (3,) m, on its surface.
/// @param outward (3,) unit length, the contact normal out of the shape.
TouchingFeature touching_feature(const Shape& shape, const Vector3& on, const Vector3& outward);

/// Where two features touch.
struct TouchingPlace {
  Vector3 on_first = Vector3::Zero(), on_second = Vector3::Zero();  ///< (3,) m
  Vector3 normal = Vector3::UnitZ();  ///< (3,) unit length, from the second towards the first
  double gap = 0.0;                   ///< m, normal.(on_first - on_second)
};

/// (3,) m: the point of a feature that is farthest in a direction; of a face, its own point.
/// @param feature of a shape. @param direction (3,) unit length.
Vector3 farthest_point(const TouchingFeature& feature, const Vector3& direction);

/// The place at which two features touch, seen along a given normal: their farthest points towards
/// each other. The point of a face is opposite that of the other feature.
/// @param first,second features of two shapes. @param normal (3,) unit length, from the second
/// feature towards the first.
TouchingPlace touching_place(const TouchingFeature& first, const TouchingFeature& second,
                             const Vector3& normal);
/// The same with the normal of the features: that of a face, the direction between the centres of
/// balls, or between the nearest points of lines. The gap is then the distance, and its gradient
/// with respect to the motions of the two points of contact is the normal. Where the features have
/// no such normal (two corners, a rim on a ball), `near` is kept.
/// @param first,second features of two shapes. @param near (3,) unit length, a normal that is less
/// than 90 degrees away.
TouchingPlace turned_place(const TouchingFeature& first, const TouchingFeature& second,
                           const Vector3& near);

}  // namespace sinew::collision
