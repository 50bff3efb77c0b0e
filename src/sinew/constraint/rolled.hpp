/// @file
/// A contact point of rigid shapes, followed through a step.
#pragma once

#include <Eigen/Geometry>

#include "sinew/collision/touching_points.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/rolling_point.hpp"

namespace sinew::constraint {

/// Where the shape of one side is.
struct ShapePlace {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< since rest
  Vector3 centre = Vector3::Zero();                        ///< (3,) m, of mass
};

/// A contact point at the present poses of its two sides, see mechanics::RollingPoint.
struct Rolled {
  Matrix3 frame;  ///< columns: normal and tangents
  /// (3,) m, where friction acts on either side: opposite places, moved to one point along the
  /// normal.
  Vector3 own_at, other_at;
  /// (3,) m, where the normal force acts. With a normal of its own, the same place. A fixed normal
  /// acts at the points whose distance along it is the gap, so that its work is that of the gap.
  Vector3 own_pressed, other_pressed;
  Vector3 motion;  ///< (3,) m: gap, and slips since the start of the step
};

/// Features of the two shapes at a contact point. If they do not have this point and gap (a contact
/// of two faces seen along the normal of neither), they are the material points of the pair, or
/// balls about the centres of curvature, and may not turn.
/// @param own,other the shapes in their poses. @param found their contact point.
/// @param result gets both features, in the axes of the world, and may_turn.
void set_features(const collision::Shape& own, const collision::Shape& other,
                  const collision::TouchingPoint& found, mechanics::RollingPoint& result);

/// The contact point at the present poses. @param point of the step.
/// @param own,other present places of its sides. @param halved see mechanics::RowValues.
/// @param on_world whether the other side is a surface of the world.
Rolled rolled(const mechanics::RollingPoint& point, const ShapePlace& own, const ShapePlace& other,
              bool halved, bool on_world);

}  // namespace sinew::constraint
