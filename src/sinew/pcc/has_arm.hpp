/// @file
/// What models of constant-curvature arms offer beside mechanics::BodyModel.
#pragma once

#include <memory>

namespace sinew::pcc {

class Arm;

/// A body model that is a constant-curvature arm: mechanics::as<HasArm>(model).
class HasArm {
 public:
  virtual ~HasArm() = default;
  virtual const Arm& arm() const = 0;
  /// For equations and dynamics of the same arm.
  virtual std::shared_ptr<const Arm> shared_arm() const = 0;
  /// Attaches one of its coordinates as a site (mechanics::Coordinate). Building only.
  /// @return the site's number. Throws Error(index-out-of-range).
  virtual int attach_coordinate(int coordinate) = 0;
};

}  // namespace sinew::pcc
