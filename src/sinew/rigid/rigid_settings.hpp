/// @file
/// Settings of a rigid body.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sinew/rigid/shape.hpp"

namespace sinew::rigid {

/// Shape, mass, initial pose and motion of a rigid body.
struct RigidSettings {
  std::string name;
  Shape shape = Box{Vector3(0.01, 0.01, 0.01)};
  std::optional<double> density;             ///< kg/m^3; alternatively, mass
  std::optional<double> mass;                ///< kg
  std::optional<Matrix3> inertia;            ///< kg m^2 about the centre of mass, in its own axes
  std::optional<Vector3> centre_of_mass;     ///< m, in its own frame; none: that of the shape
  Vector3 position = Vector3::Zero();        ///< m, position of its origin
  Matrix3 rotation = Matrix3::Identity();    ///< columns: its axes
  Vector3 shape_position = Vector3::Zero();  ///< m, of the shape's origin, in its own frame
  Matrix3 shape_rotation = Matrix3::Identity();  ///< columns: the shape's axes, in its own frame
  std::shared_ptr<const mesh::Surface> look;     ///< to display, in its own frame; none: its shape
  Vector3 velocity = Vector3::Zero();            ///< m/s, of the centre of mass
  Vector3 spin = Vector3::Zero();                ///< rad/s, in world axes
  bool fixed = false;
  Vector3 gravity = Vector3::Zero();  ///< m/s^2
};

}  // namespace sinew::rigid
