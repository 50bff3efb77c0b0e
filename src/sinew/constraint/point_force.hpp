/// @file
/// A force of given direction on a material point, as an actuator.
#pragma once

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// A force along a fixed direction. One row: effort = force along `direction` (N, either sign),
/// delta = displacement of the point along it since rest (m).
class PointForce : public Constraint {
 public:
  /// @param name for messages.
  /// @param point where the force acts.
  /// @param direction (3,) fixed in the world; normalised here. Throws Error(out-of-range) if zero.
  /// @param rest_position (3,) m of the point.
  PointForce(std::string name, mechanics::MaterialPoint point, const Vector3& direction,
             const Vector3& rest_position);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;

  void describe(PartVisitor& visitor) const override { visitor.add(direction_, rest_position_); }

  const mechanics::MaterialPoint& point() const { return point_; }
  const Vector3& direction() const { return direction_; }

 private:
  mechanics::MaterialPoint point_;
  Vector3 direction_;
  Vector3 rest_position_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
