/// @file
/// The interface of constant-curvature arms, besides mechanics::BodyModel.
#pragma once

#include <memory>

namespace sinew::pcc {

class Arm;

/// A body model that is a constant-curvature arm. Query it by `mechanics::as<HasArm>(model)`.
class HasArm {
 public:
  virtual ~HasArm() = default;
  virtual const Arm& arm() const = 0;
  /// The same arm with shared ownership, for ArmEquations and ArmDynamics.
  virtual std::shared_ptr<const Arm> shared_arm() const = 0;
  /// Attaches a generalised coordinate as a site (mechanics::Coordinate). Only during building.
  /// @return the site's number. Throws Error(index-out-of-range).
  virtual int attach_coordinate(int coordinate) = 0;
};

}  // namespace sinew::pcc
