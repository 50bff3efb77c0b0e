/// @file
/// Welds and joints between bodies.
#pragma once

#include <string>
#include <vector>

#include "sinew/constraint/joint_type.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model_data.hpp"

namespace sinew::builder {

/// A weld, which makes two bodies one: points of the first keep their positions in the material of
/// the second.
struct WeldSettings {
  std::string name;
  Location place;
  int first = 0, second = 1;  ///< bodies
  std::vector<NodeId> nodes;  ///< of the first's mesh
  Points points;              ///< (n, 3) m, at rest, in addition to nodes
  /// Treatment of points outside the mesh of a body.
  mesh::Outside outside = mesh::Outside::error;
};

/// A joint between rigid parts of two bodies, or of one body and the world, which move relative to
/// each other as the type permits.
struct JointSettings {
  std::string name;
  Location place;
  constraint::JointType type = constraint::JointType::hinge;
  int first = 0, second = 1;               ///< bodies; kWorld: the world
  Vector3 point = Vector3::Zero();         ///< (3,) m, of the joint, at rest
  Vector3 axis = Vector3::UnitZ();         ///< at rest; of a universal joint, fixed in the first
  Vector3 second_axis = Vector3::UnitX();  ///< of a universal joint, fixed in the second
  model::Limits angle, displacement;       ///< rad, m
  double friction = 0.0;                   ///< N m of a hinge, N of a slider, >= 0
};

}  // namespace sinew::builder
