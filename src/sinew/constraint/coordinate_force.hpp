/// @file
/// A generalised force on one of a body's coordinates, as an actuator.
#pragma once

#include "sinew/constraint/constraint.hpp"

namespace sinew::constraint {

/// A generalised force on a coordinate. One row: effort = generalised force (N m; N for an
/// extension), delta = the coordinate (rad; m).
class CoordinateForce : public Constraint {
 public:
  /// @param name for messages. @param coordinate where the force acts.
  CoordinateForce(std::string name, mechanics::Coordinate coordinate);

  void declare(mechanics::RowPattern& rows,
               std::vector<mechanics::StiffnessPair>& stiffness_pairs) override;
  void linearise(const Configuration& configuration, mechanics::RowValues& values) const override;
  /// Hashed as a force along the first axis, so that fingerprints of saved states stay the same.
  void describe(PartVisitor& visitor) const override {
    visitor.add(Vector3(1, 0, 0), Vector3(0, 0, 0));
  }

 private:
  mechanics::Coordinate coordinate_;
  int first_entry_ = -1;
};

}  // namespace sinew::constraint
