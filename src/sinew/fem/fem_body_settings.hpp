/// @file
/// Settings of a finite-element robot.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/linalg/factorisation.hpp"
#include "sinew/mesh/embedding.hpp"

namespace sinew::fem {

/// Rayleigh damping C = mass M + stiffness K.
struct RayleighDamping {
  double mass = 0.0;       ///< 1/s, >= 0
  double stiffness = 0.0;  ///< s, >= 0
};

/// A point mass attached to the body, such as a weight or a camera.
struct PointMassSettings {
  std::string name;
  Location place;                   ///< for error messages
  Vector3 point = Vector3::Zero();  ///< m, at rest
  double mass = 0.0;                ///< kg, > 0
  mesh::Outside outside = mesh::Outside::error;
};

/// Initial velocity: a rigid motion.
struct InitialVelocity {
  Vector3 linear = Vector3::Zero();   ///< m/s, of the centre of mass
  Vector3 angular = Vector3::Zero();  ///< rad/s, about it
};

/// Settings of one finite-element body.
struct FemBodySettings {
  std::string name;
  std::shared_ptr<const mesh::Mesh> mesh;
  std::shared_ptr<const mesh::Embedder> embedder;  ///< of `mesh`; null: the body makes its own
  FemModelSettings elements;                       ///< couplings are filled in by finish()
  Vector3 gravity = Vector3::Zero();               ///< m/s^2
  RayleighDamping damping;
  std::vector<PointMassSettings> masses;
  InitialVelocity initial_velocity;  ///< of the free nodes; used in dynamics only
  linalg::FactorisationSettings factorisation;
};

}  // namespace sinew::fem
