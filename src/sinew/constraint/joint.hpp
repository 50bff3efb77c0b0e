/// @file
/// Joints between two bodies with rigid parts, or between such a body and the world.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/joint_type.hpp"

namespace sinew::constraint {

/// Where a joint is attached to a body, or to the world: then neither site has a body.
struct JointSide {
  mechanics::MaterialPoint point;
  mechanics::Orientation orientation;  ///< without a body: all rotations are free
  Vector3 rest = Vector3::Zero();      ///< position of the point at rest, m
};

/// The present frames of a joint, one on each side: an origin, and axes whose third is the axis of
/// the joint. The two frames coincide at rest. Motions of the second are measured in the first.
struct JointFrames {
  std::array<Vector3, 2> origin;
  std::array<Matrix3, 2> axes;

  Vector3 offset() const { return origin[1] - origin[0]; }
  /// Rotation about the third axis of the first frame, rad in (-pi, pi].
  double angle() const;
  /// Displacement along that axis, m.
  double slide() const { return axes[0].col(2).dot(offset()); }
};

/// The two sides of a joint, which Joint and JointMotion share.
class JointPlace {
 public:
  /// @param first,second its two sides: motions of the second are measured in the first.
  /// @param axes (3, 3) orthonormal, at rest.
  JointPlace(const JointSide& first, const JointSide& second, const Matrix3& axes);
  JointFrames frames(const Configuration& configuration) const;

  const std::array<JointSide, 2>& sides() const { return sides_; }
  /// Adds a row on the points, the orientations or both, of the sides that are bodies, in the
  /// order: point of the second, point of the first, orientation of the second, orientation of the
  /// first.
  int add_row(mechanics::RowPattern& rows, bool points, bool orientations) const;
  /// Write the directions of such a row, for the sides that are bodies. write_points() writes
  /// `direction` for the second side's point and its opposite for the first's; write_turns() writes
  /// `second` and `first` for the orientations, unchanged.
  /// @return the next entry.
  Vector3* write_points(Vector3* entry, const Vector3& direction) const;
  Vector3* write_turns(Vector3* entry, const Vector3& second, const Vector3& first) const;
  void describe(PartVisitor& visitor) const { visitor.add(axes_, sides_[0].rest); }
  const Matrix3& axes() const { return axes_; }  ///< at rest

 private:
  std::array<JointSide, 2> sides_;
  Matrix3 axes_;
};

/// A joint: rows that are held at zero. With r from the first side's point to the second's, and the
/// axes a_1, a_2, a_3 of the first side and b_1, b_2, b_3 of the second,
/// - displacements: r = 0 along the world's axes, or a_1.r = a_2.r = 0 for a joint that slides;
/// - rotations: a_i.b_j = 0, with the derivative (b_j x a_i).(theta_b - theta_a): the axes stay
///   perpendicular (Shabana, Dynamics of Multibody Systems, 2013, sec. 7.4).
/// The axes of both sides coincide at rest, so all rows are zero there. The second axis of a
/// universal joint is b_1.
class Joint : public Constraint {
 public:
  /// @param name for messages. @param type which motions it holds.
  /// @param place its sides must have orientations if the type holds a rotation or slides.
  Joint(std::string name, JointType type, const JointPlace& place);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void describe(PartVisitor& visitor) const override;

  JointType type() const { return type_; }
  const JointPlace& place() const { return place_; }
  /// Directions of its rows at rest: those of the displacements, then the axes of the rotations.
  std::vector<Vector3> rest_directions() const;
  int displacements() const { return displacements_; }
  /// Whether a row holds a rotation: its motion is in rad, its effort in N m.
  bool is_turn(int row) const { return row - first_row_ >= displacements_; }
  /// Force and moment of a joint.
  struct Load {
    Vector3 force = Vector3::Zero();   ///< N
    Vector3 moment = Vector3::Zero();  ///< N m
  };
  /// Force and moment on the second body, at its point, due to the efforts of the rows.
  /// @param configuration the present one. @param effort (row_count(),) N and N m.
  Load load(const Configuration& configuration, std::span<const double> effort) const;
  /// Distance between the two points, m; for a joint that slides, measured across its axis.
  double gap(const Configuration& configuration) const;

 private:
  // Direction of a displacement, or axis of a rotation. row: counted from 0 within this joint.
  Vector3 direction(const JointFrames& frames, int row) const;

  JointType type_;
  JointPlace place_;
  int displacements_ = 3;
  std::span<const std::array<int, 2>> turns_;  // a_i and b_j of each row
  int first_entry_ = -1;
};

/// The free motion of a hinge or slider as a row: its angle, rad, with a moment as effort, or its
/// displacement, m, with a force. Motors, limits and brakes of the joint act on this row.
class JointMotion : public Constraint {
 public:
  enum class Kind { angle, displacement };
  JointMotion(std::string name, Kind kind, const JointPlace& place);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void describe(PartVisitor& visitor) const override;
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
  JointPlace place_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
