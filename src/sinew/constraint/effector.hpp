/// @file
/// Effectors: what is steered or watched. Rows without effort.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// What an effector measures.
enum class EffectorKind {
  point,        ///< where something is, m
  orientation,  ///< how something has turned since rest, rad
};
/// "point", "orientation".
const char* effector_kind_name(EffectorKind kind);

/// A place whose rows say how it moves. `delta` of a row is the coordinate itself.
class Effector : public Constraint {
 public:
  /// Where it is: (3,) m for positions; the rotation vector since rest, rad, for orientations.
  virtual Vector3 value(const Configuration& configuration) const = 0;
  /// Unit directions of its rows in the world (rows, each (3,)).
  const std::vector<Vector3>& directions() const { return directions_; }
  /// What delta must become for the effector to meet `target` (given as value() is): (rows,).
  virtual void target_delta(const Configuration& configuration, const Vector3& target,
                            Eigen::Ref<VectorX> delta) const = 0;
  virtual EffectorKind kind() const = 0;
  /// Of value(): "m" or "rad".
  const char* unit() const { return kind() == EffectorKind::point ? "m" : "rad"; }
  void add_to(ValueHash& hash) const override { hash.add(directions_); }

 protected:
  Effector(std::string name, std::vector<Vector3> directions);
  std::vector<Vector3> directions_;
  int first_entry_ = -1;
};

/// A material point, or the mean of a set attached as one point, along chosen directions.
class PointEffector : public Effector {
 public:
  /// @param name for messages.
  /// @param point the attached point.
  /// @param directions one row each; empty means x, y and z. Normalised here.
  PointEffector(std::string name, mechanics::MaterialPoint point,
                std::vector<Vector3> directions = {});

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  Vector3 value(const Configuration& configuration) const override;
  void target_delta(const Configuration& configuration, const Vector3& target,
                    Eigen::Ref<VectorX> delta) const override;
  EffectorKind kind() const override { return EffectorKind::point; }
  const mechanics::MaterialPoint& point() const { return point_; }

 private:
  mechanics::MaterialPoint point_;
};

/// How something on the robot has turned. Rows are the rotation's components about the world's
/// axes; value() is the rotation vector of R, the rotation since rest.
class OrientationEffector : public Effector {
 public:
  Vector3 value(const Configuration& configuration) const override;
  void target_delta(const Configuration& configuration, const Vector3& target,
                    Eigen::Ref<VectorX> delta) const override;
  EffectorKind kind() const override { return EffectorKind::orientation; }

 protected:
  explicit OrientationEffector(std::string name) : Effector(std::move(name), {}) {}

 private:
  virtual Matrix3 rotation(const Configuration& configuration) const = 0;
};

/// A part that stays rigid, such as a section of an arm.
class SectionOrientation : public OrientationEffector {
 public:
  /// @param name for messages. @param section its rotation.
  SectionOrientation(std::string name, mechanics::Orientation section);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;

 private:
  Matrix3 rotation(const Configuration& configuration) const override;

  mechanics::Orientation section_;
};

/// The frame through three points a, b, c: e1 along b - a, e3 normal to the triangle,
/// e2 = e3 x e1; R = E(now) E(rest)^T. The Jacobian follows from de1 = omega x e1 and the
/// motion of c along e3: omega = omega_1 e1 + omega_2 e2 + omega_3 e3 with
///   omega_3 = e2.(b'-a')/|b-a|,  omega_2 = -e3.(b'-a')/|b-a|,
///   omega_1 = (e3.(c'-a') + alpha omega_2)/beta,   c - a = alpha e1 + beta e2.
class TriangleOrientation : public OrientationEffector {
 public:
  /// @param name for messages.
  /// @param points a, b, c.
  /// @param rest_positions of a, b, c, m. Throws Error(degenerate-orientation) when collinear.
  TriangleOrientation(std::string name, std::array<mechanics::MaterialPoint, 3> points,
                      const std::array<Vector3, 3>& rest_positions);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void add_to(ValueHash& hash) const override { hash.add(directions_, rest_frame_); }

 private:
  Matrix3 rotation(const Configuration& configuration) const override;

  std::array<mechanics::MaterialPoint, 3> points_;
  Matrix3 rest_frame_;
};

}  // namespace sinew::constraint
