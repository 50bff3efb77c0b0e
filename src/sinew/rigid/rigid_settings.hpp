/// @file
/// What a rigid body is.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sinew/rigid/shape.hpp"

namespace sinew::rigid {

struct RigidSettings {
  std::string name;
  Shape shape = Box{Vector3(0.01, 0.01, 0.01)};
  std::optional<double> density;             ///< kg/m^3; or
  std::optional<double> mass;                ///< kg
  std::optional<Matrix3> inertia;            ///< kg m^2 about the centre of mass, in its own axes
  std::optional<Vector3> centre_of_mass;     ///< m, in its own frame; else the shape's
  Vector3 position = Vector3::Zero();        ///< m, of its origin
  Matrix3 rotation = Matrix3::Identity();    ///< of its axes
  Vector3 shape_position = Vector3::Zero();  ///< m, of the shape's origin, in its own frame
  Matrix3 shape_rotation = Matrix3::Identity();  ///< of the shape's axes, likewise
  std::shared_ptr<const mesh::Surface> look;  ///< that shows it, in its own frame; else its shape
  Vector3 velocity = Vector3::Zero();         ///< m/s, of the centre of mass
  Vector3 spin = Vector3::Zero();             ///< rad/s, about the world's axes
  bool fixed = false;
  Vector3 gravity = Vector3::Zero();  ///< m/s^2
};

}  // namespace sinew::rigid
