/// @file
/// Capability of body models: loads of the environment.
#pragma once

#include <string>

#include "sinew/core/part_visitor.hpp"
#include "sinew/core/types.hpp"
#include "sinew/mechanics/loads.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::mechanics {

/// A body model on which loads act: mechanics::as<BearsLoads>(model). Its bodies are TakesLoads.
class BearsLoads {
 public:
  virtual ~BearsLoads() = default;
  /// The mesh at rest whose nodes and faces loads name.
  virtual const mesh::Mesh& load_mesh() const = 0;
  /// Nodes and weights that carry a force on a point. Building only. The nodes of a rigid body may
  /// lie beyond those of load_mesh(). Throws as BodyModel::attach() does.
  virtual mesh::EmbeddedPoint carry(const Vector3& rest_position, mesh::Outside outside,
                                    const std::string& what) = 0;
  /// The forces that give all of its mass an acceleration, (3,) m/s^2. Building only.
  virtual DeadLoad inertial_load(const Vector3& acceleration) = 0;
  virtual const Vector3& gravity() const = 0;  ///< (3,) m/s^2
  /// Adds a load and returns its number. Building only.
  virtual int add_load(Load load) = 0;
  /// Visits a load, by its number. After finish().
  virtual void describe_load(int load, PartVisitor& visitor) const = 0;
};

}  // namespace sinew::mechanics
