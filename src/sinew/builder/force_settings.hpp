/// @file
/// A force as an actuator.
#pragma once

#include <string>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"

namespace sinew::builder {

/// The kind of forces.
inline constexpr model::ActuatorKind kForceKind{
    .word = "force", .effort = {"force", "N"}, .motion = {"displacement", "m"}, .number = 1};

/// A force along a fixed direction on a point.
struct ForceSettings {
  std::string name;
  Location place;
  int body = 0;
  Vector3 point = Vector3::Zero();  ///< m, at rest
  Vector3 direction = Vector3::UnitZ();
  mesh::Outside outside = mesh::Outside::error;
  model::Limits force;         ///< N
  model::Limits displacement;  ///< m
  model::Command command;
};

}  // namespace sinew::builder
