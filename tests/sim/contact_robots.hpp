// Blocks that rest, slide and are pressed, shared by tests of contact.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::testing {

inline constexpr double kGravity = 9.81;

/// A block of rubber, 40 x 40 x 20 mm, on or above the plane z = 0. The plane is inclined by
/// rotating gravity, so that x points downhill.
struct BlockOptions {
  model::StepSettings step{.time_step = 1e-3, .integrator = mechanics::Integrator::backward_euler};
  double angle = 0.0;  ///< rad
  double friction = 0.5;
  double height = 0.0;   ///< m, initial height of its bottom
  double modulus = 1e6;  ///< Pa
  std::array<int, 3> cells{4, 4, 2};
  fem::RayleighDamping damping{.mass = 0.0, .stiffness = 0.002};
  bool floor = true;
  double aggregate = 0.0;  ///< m, size of contact zones
  bool top_fixed = false;
  linalg::FactorisationSettings factorisation;
};

inline constexpr double kBlockDensity = 1000.0;
inline constexpr double kBlockWeight = kBlockDensity * 0.04 * 0.04 * 0.02 * kGravity;

/// A builder with the block as body 0 and the floor as contact 0.
inline builder::ModelBuilder block_on_plane(const BlockOptions& options) {
  builder::ModelBuilder builder(options.step);
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh =
      std::make_shared<const mesh::Mesh>(mesh::block({.corner = {-0.02, -0.02, options.height},
                                                      .size = {0.04, 0.04, 0.02},
                                                      .cells = options.cells}));
  body.mesh = mesh;
  body.gravity = kGravity * Vector3(std::sin(options.angle), 0.0, -std::cos(options.angle));
  body.damping = options.damping;
  body.elements.regions = {
      {{options.modulus, 0.3}, material::Law::corotational, kBlockDensity, {}}};
  if (options.top_fixed) body.elements.fixed_nodes = mesh->node_sets.at("z_max");
  body.factorisation = options.factorisation;
  builder.add_body<fem::FemBodyModel>(std::move(body));
  if (options.floor) {
    builder::ContactSettings floor;
    floor.name = "floor";
    floor.surface = collision::Plane{};
    floor.nodes = mesh->node_sets.at("z_min");
    floor.friction = options.friction;
    floor.aggregate = options.aggregate;
    builder.add_contact(floor);
  }
  return builder;
}

/// Mean velocity of the block's nodes, m/s; with equal cells it is close to that of the centre of
/// mass.
inline Vector3 mean_velocity(const sim::Simulation& simulation) {
  return simulation.body(0).velocities().colwise().mean().transpose();
}

}  // namespace sinew::testing
