// Small robots shared by the tests of sim, constraint and inverse.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/builder/probe_settings.hpp"
#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/fem/fem_model.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::testing {

inline constexpr double kRightAngle = 1.57079632679489662;

/// A clamped silicone beam along x, 100 x 20 x 20 mm, with four cables at 6 mm from its axis (up,
/// left, down, right) and its tip as effector.
struct BeamOptions {
  model::StepSettings step;
  Vector3 gravity = Vector3::Zero();
  fem::RayleighDamping damping;
  int cables = 4;
  model::Limits tension{.min = 0.0};
  model::Limits displacement;
  bool pull_from_world = true;
  bool geometric_stiffness = false;
  double friction = 0.0;
  bool clamped = true;
  fem::MassMatrix mass = fem::MassMatrix::lumped;
  material::Law law = material::Law::corotational;
  double young_modulus = 200e3;  // Pa
  linalg::FactorisationSettings factorisation;
  std::optional<double> wall;  ///< z of a plane below the beam, m
  double wall_friction = 0.3;
  bool probes = false;  ///< "end" at the tip, "axis" of six points, "bend" of both ends
};

inline std::shared_ptr<const model::Model> beam(const BeamOptions& options = {}) {
  builder::ModelBuilder builder(options.step);
  fem::FemBodySettings body;
  body.name = "beam";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {0.0, -0.01, -0.01}, .size = {0.1, 0.02, 0.02}, .cells = {10, 2, 2}}));
  body.mesh = mesh;
  body.gravity = options.gravity;
  body.damping = options.damping;
  body.elements.regions = {{{options.young_modulus, 0.4}, options.law, 1070.0, {}}};
  body.elements.mass = options.mass;
  if (options.clamped) body.elements.fixed_nodes = mesh->node_sets.at("x_min");
  body.factorisation = options.factorisation;
  const int beam = builder.add_body<fem::FemBodyModel>(std::move(body));
  for (int k = 0; k < options.cables; ++k) {
    builder::CableSettings cable;
    cable.name = "cable_" + std::to_string(k);
    cable.body = beam;
    cable.points.resize(6, 3);
    const double angle = k * kRightAngle;
    for (int i = 0; i < 6; ++i) {
      cable.points.row(i) << (i == 0 ? 0.0 : 0.002 + 0.019 * i), 0.006 * std::sin(angle),
          0.006 * std::cos(angle);
    }
    cable.pull_from_world = options.pull_from_world;
    cable.tension = options.tension;
    cable.displacement = options.displacement;
    cable.geometric_stiffness = options.geometric_stiffness;
    cable.friction = options.friction;
    builder.add_cable(cable);
  }
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.body = beam;
  tip.points.resize(1, 3);
  tip.points << 0.1, 0.0, 0.0;
  builder.add_effector(tip);
  if (options.wall) {
    builder::ContactSettings wall;
    wall.name = "wall";
    wall.body = beam;
    wall.surface = collision::Plane{{0.0, 0.0, *options.wall}, Vector3::UnitZ()};
    wall.nodes = mesh->node_sets.at("z_min");
    wall.friction = options.wall_friction;
    builder.add_contact(wall);
  }
  if (options.probes) {
    builder.add_probe({"end", {}, mesh::Outside::error, builder::ProbeSpot{beam, tip.points, {}}});
    builder::ProbeLine axis{beam, Points(2, 3), 6};
    axis.corners << 0.0, 0.0, 0.0, 0.1, 0.0, 0.0;
    builder.add_probe({"axis", {}, mesh::Outside::error, axis});
    const auto& sets = mesh->node_sets;
    builder.add_probe(
        {"bend",
         {},
         mesh::Outside::error,
         builder::ProbeBend{{{{beam, sets.at("x_min"), {}}, {beam, sets.at("x_max"), {}}}}, {}}});
  }
  return builder.build();
}

inline model::Command pull(double metres) {
  return {model::CommandKind::motion, model::Signal::constant(metres)};
}
inline model::Command tension(double newtons) {
  return {model::CommandKind::effort, model::Signal::constant(newtons)};
}

}  // namespace sinew::testing
