/// @file
/// Effectors: quantities that are controlled or observed. Rows without effort.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// What an effector measures.
enum class EffectorKind {
  point,        ///< position, m
  orientation,  ///< rotation vector since rest, rad
};
/// "point", "orientation".
const char* effector_kind_name(EffectorKind kind);

/// A place on the robot whose motion its rows measure. The `delta` of a row is the coordinate
/// itself.
class Effector : public Constraint {
 public:
  /// Present value: (3,) m for a position; the rotation vector since rest, (3,) rad, for an
  /// orientation.
  virtual Vector3 value(const Configuration& configuration) const = 0;
  /// Unit directions of its rows in world axes (rows, each (3,)).
  const std::vector<Vector3>& directions() const { return directions_; }
  /// Value of delta at which the effector meets `target` (given as value() is): (rows,).
  virtual void target_delta(const Configuration& configuration, const Vector3& target,
                            Eigen::Ref<VectorX> delta) const = 0;
  virtual EffectorKind kind() const = 0;
  /// Unit of value(): "m" or "rad".
  const char* unit() const { return kind() == EffectorKind::point ? "m" : "rad"; }
  void describe(PartVisitor& visitor) const override { visitor.add(directions_); }

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
  /// @param directions one per row; empty means x, y and z. They are normalised here.
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

/// The rotation of a part of the robot. Its rows are the components of the rotation about the
/// world's axes; value() is the rotation vector of R, the rotation since rest.
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

/// The orientation of a part that stays rigid, such as a section of an arm.
class SectionOrientation : public OrientationEffector {
 public:
  /// @param name for messages. @param section whose rotation is measured.
  SectionOrientation(std::string name, mechanics::Orientation section);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;

 private:
  Matrix3 rotation(const Configuration& configuration) const override;

  mechanics::Orientation section_;
};

/// The orientation of the frame through three points a, b, c: e1 along b - a, e3 normal to the
/// triangle, e2 = e3 x e1; R = E(now) E(rest)^T. The Jacobian follows from de1 = omega x e1 and
/// from the motion of c along e3: omega = omega_1 e1 + omega_2 e2 + omega_3 e3 with
///   omega_3 = e2.(b'-a')/|b-a|,  omega_2 = -e3.(b'-a')/|b-a|,
///   omega_1 = (e3.(c'-a') + alpha omega_2)/beta,   c - a = alpha e1 + beta e2.
class TriangleOrientation : public OrientationEffector {
 public:
  /// @param name for messages.
  /// @param points a, b, c.
  /// @param rest_positions of a, b, c, m. Throws Error: degenerate-orientation if they are
  ///   collinear.
  TriangleOrientation(std::string name, std::array<mechanics::MaterialPoint, 3> points,
                      const std::array<Vector3, 3>& rest_positions);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  void describe(PartVisitor& visitor) const override { visitor.add(directions_, rest_frame_); }

 private:
  Matrix3 rotation(const Configuration& configuration) const override;

  std::array<mechanics::MaterialPoint, 3> points_;
  Matrix3 rest_frame_;
};

}  // namespace sinew::constraint
