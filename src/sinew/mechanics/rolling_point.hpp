/// @file
/// Contact points of rigid shapes that move along the shapes within a step.
#pragma once

#include <Eigen/Geometry>

#include "sinew/collision/touching_feature.hpp"
#include "sinew/core/types.hpp"

namespace sinew::mechanics {

/// A contact point of two rigid shapes in a step. It is the place at which two features of the
/// shapes touch (collision::TouchingFeature). As the shapes roll, it moves along both of them, so
/// its forces act where the shapes touch when the forces act, and not at the material points that
/// touched when the step began. With the lever r(t) of the contact point from a material point X(t)
/// of a side, the side moves there by
///   integral of dX/dt + w x r = X - X_start + theta x (r_start + r)/2 + O(h^3),
/// with the rotation vector theta of the step (RigidState::motion()). The slip is the difference of
/// the two sides. In the first half of a step of the midpoint rule, r and w are those of the
/// middle:
///   integral over half of the step = c - c_start + theta x (x sin(a)/a + r),   a = |theta|,
/// with the centre of mass c and x = X - c. The factor sin(a)/a makes the motion of X in the whole
/// step exact.
///
/// The gap is that of the features with their present normal (Turning::end), and the force acts
/// along it where formulas of second order need it. The work of this force is not that of the gap,
/// which is constant while the shapes roll: in a step of backward Euler, it would add energy of
/// second order. There, the force acts along the mean of the normals at both ends, and friction at
/// the mean levers (Turning::mean). For two balls with centres a apart at the start and b at the
/// end, that is the discrete gradient (a + b)/(|a| + |b|) of the distance, whose product with b - a
/// is |b| - |a| (Gonzalez, J. Nonlinear Sci. 6, 1996, 449). The work of the step is then zero.
struct RollingPoint {
  /// What the normal does in a step.
  enum class Turning : char {
    fixed,  ///< keeps its direction: a tangent plane, which no point can pass unnoticed
    mean,   ///< follows the features; forces act along the mean of both ends
    end,    ///< follows the features; forces act along that of the end
  };
  /// One of the two shapes.
  struct Side {
    collision::TouchingFeature feature;  ///< at rest, in the axes of its body or surface
    Vector3 core = Vector3::Zero();      ///< (3,) m, X_start: the feature's point
    Vector3 lever = Vector3::Zero();     ///< (3,) m, r_start
    Vector3 centre = Vector3::Zero();    ///< (3,) m, c_start
    Matrix3 rotation = Matrix3::Zero();  ///< since rest, at the start
  };
  Side own, other;
  /// Poses of a surface of the world at the end of the step, and of a halved step's second half.
  Eigen::Isometry3d surface = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d surface_ahead = Eigen::Isometry3d::Identity();
  Matrix3 frame = Matrix3::Identity();  ///< columns: normal and tangents at the start
  Vector3 offset = Vector3::Zero();     ///< (3,) m, of its rows at the start
  bool used = false;                    ///< whether the point is one of the present step
  bool may_turn = false;                ///< whether its features have a normal of their own
  Turning turning = Turning::fixed;     ///< of its normal in this step
};

}  // namespace sinew::mechanics
