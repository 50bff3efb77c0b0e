/// @file
/// What a rigid body is.
#pragma once

#include <optional>
#include <string>

#include "sinew/rigid/shape.hpp"

namespace sinew::rigid {

struct RigidSettings {
  std::string name;
  Shape shape = Box{Vector3(0.01, 0.01, 0.01)};
  std::optional<double> density;           ///< kg/m^3; or
  std::optional<double> mass;              ///< kg
  std::optional<Matrix3> inertia;          ///< kg m^2 about the centre, in the shape's axes
  Vector3 position = Vector3::Zero();      ///< m, of the shape's origin
  Matrix3 rotation = Matrix3::Identity();  ///< of the shape's axes
  Vector3 velocity = Vector3::Zero();      ///< m/s, of the centre of mass
  Vector3 spin = Vector3::Zero();          ///< rad/s, about the world's axes
  bool fixed = false;
  Vector3 gravity = Vector3::Zero();  ///< m/s^2
};

}  // namespace sinew::rigid
