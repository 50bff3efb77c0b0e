/// @file
/// Joints between bodies with parts that stay rigid, or between such a body and the world.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "sinew/constraint/constraint.hpp"
#include "sinew/constraint/joint_type.hpp"

namespace sinew::constraint {

/// Where a joint stands on a body, or in the world: then no site has a body.
struct JointSide {
  mechanics::MaterialPoint point;
  mechanics::Orientation orientation;  ///< none: the joint leaves all rotations
  Vector3 rest = Vector3::Zero();      ///< m, of the point
};

/// The frames of a joint now, one on each side, which are one at rest: an origin, and axes whose
/// third is the joint's. Motions of the second are measured in the first.
struct JointFrames {
  std::array<Vector3, 2> origin;
  std::array<Matrix3, 2> axes;

  Vector3 offset() const { return origin[1] - origin[0]; }
  /// rad in (-pi, pi], about the first's third axis.
  double angle() const;
  /// m, along it.
  double slide() const { return axes[0].col(2).dot(offset()); }
};

/// What both of a joint's constraints stand on.
class JointPlace {
 public:
  /// @param first,second its two sides: motions of the second are measured in the first.
  /// @param axes (3, 3) orthonormal, at rest.
  JointPlace(const JointSide& first, const JointSide& second, const Matrix3& axes);
  JointFrames frames(const Configuration& configuration) const;

  const std::array<JointSide, 2>& sides() const { return sides_; }
  /// Adds a row that touches points, orientations or both, of the sides that are bodies: the
  /// second's point, the first's, the second's orientation, the first's.
  int add_row(mechanics::RowPattern& rows, bool points, bool orientations) const;
  /// Writes directions of such a row, of the sides that are bodies: on the second's point and its
  /// opposite on the first's; on the second's orientation, and `first` on the first's as it stands.
  /// @return the next entry.
  Vector3* write_points(Vector3* entry, const Vector3& direction) const;
  Vector3* write_turns(Vector3* entry, const Vector3& second, const Vector3& first) const;
  void add_to(ValueHash& hash) const { hash.add(axes_, sides_[0].rest); }
  const Matrix3& axes() const { return axes_; }  ///< at rest

 private:
  std::array<JointSide, 2> sides_;
  Matrix3 axes_;
};

/// Rows that are held at zero. With r from the first side's point to the second's, and the axes
/// a_1, a_2, a_3 of the first and b_1, b_2, b_3 of the second,
/// - displacements: r = 0 along the world's axes, or a_1.r = a_2.r = 0 of what slides;
/// - turns: a_i.b_j = 0, whose change is (b_j x a_i).(theta_b - theta_a): axes stay normal to one
///   another (Shabana, Dynamics of Multibody Systems, 2013, sec. 7.4).
/// Both sides' axes are one at rest, so that all rows are zero there. A universal joint's second
/// axis is b_1.
class Joint : public Constraint {
 public:
  /// @param name for messages. @param type what it holds.
  /// @param place whose sides have orientations where the type holds a turn or slides.
  Joint(std::string name, JointType type, const JointPlace& place);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void add_to(ValueHash& hash) const override;

  JointType type() const { return type_; }
  const JointPlace& place() const { return place_; }
  /// Of its rows where the bodies are at rest: of displacements, then axes of turns.
  std::vector<Vector3> rest_directions() const;
  int displacements() const { return displacements_; }
  /// Whether a row holds a turn: its motion is in rad, its effort in N m.
  bool is_turn(int row) const { return row - first_row_ >= displacements_; }
  struct Load {
    Vector3 force = Vector3::Zero();   ///< N
    Vector3 moment = Vector3::Zero();  ///< N m
  };
  /// On the second body, at its point, by the efforts of its rows.
  /// @param configuration of now. @param effort (row_count(),) N and N m.
  Load load(const Configuration& configuration, std::span<const double> effort) const;
  /// m: how far apart the two points are, of what slides across the axis.
  double gap(const Configuration& configuration) const;

 private:
  // Of a displacement, or the axis of a turn. row: of its own, from 0.
  Vector3 direction(const JointFrames& frames, int row) const;

  JointType type_;
  JointPlace place_;
  int displacements_ = 3;
  std::span<const std::array<int, 2>> turns_;  // a_i and b_j of each row
  int first_entry_ = -1;
};

/// The one motion that a hinge or slider leaves, as a row: its angle, rad, and a moment, or its
/// displacement, m, and a force. What drives, limits or brakes the joint acts there.
class JointMotion : public Constraint {
 public:
  enum class Kind { angle, displacement };
  JointMotion(std::string name, Kind kind, const JointPlace& place);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void add_to(ValueHash& hash) const override;
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
  JointPlace place_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
