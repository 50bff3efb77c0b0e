// A beam along x that is cut into two bodies and welded together.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "sinew/builder/cable_settings.hpp"
#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/joint_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::testing {

inline constexpr double kBeamLength = 0.1;  // m
inline constexpr double kBeamGravity = 9.81;

struct CutBeam {
  model::StepSettings step;
  bool cut = true;  ///< in the middle, into two bodies
  int finer = 1;    ///< ratio of the cells across the second part to those across the first
  Vector3 gravity{0.0, 0.0, -kBeamGravity};
  bool rubber = false;  ///< whether neo-Hookean, else corotational
  int cables = 0;       ///< up to 3, through both parts: top, left, bottom
  double cable_friction = 0.0;
  bool push = false;  ///< whether a force acts on the tip
  bool second_fixed = false;
  bool weld = true;
  std::optional<double> wall;  ///< z of a plane below the second part, m
};

inline std::shared_ptr<const mesh::Mesh> beam_part(double from, double to, int cells, int across) {
  return std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {from, -0.01, -0.01},
                   .size = {to - from, 0.02, 0.02},
                   .cells = {cells, 2 * across, 2 * across}}));
}

inline int add_part(builder::ModelBuilder& builder, const char* name,
                    const std::shared_ptr<const mesh::Mesh>& mesh, const CutBeam& options,
                    bool fixed, const char* end) {
  fem::FemBodySettings body;
  body.name = name;
  body.mesh = mesh;
  body.gravity = options.gravity;
  body.elements.regions = {{{200e3, 0.35}, material::Law::corotational, 1070.0}};
  if (options.rubber) {
    body.elements.regions[0].hyperelastic = material::neo_hookean(7e4);
    body.elements.regions[0].hyperelastic->bulk_modulus = 2e5;
  }
  if (fixed) body.elements.fixed_nodes = mesh->node_sets.at(end);
  return builder.add_body<fem::FemBodyModel>(std::move(body));
}

/// Both parts have even numbers of cells along x, so that they split like those of the whole beam.
inline std::shared_ptr<const model::Model> cut_beam(const CutBeam& options) {
  builder::ModelBuilder builder(options.step);
  const double middle = 0.5 * kBeamLength;
  const auto whole = beam_part(0.0, kBeamLength, 12, 1);
  const auto lower = options.cut ? beam_part(0.0, middle, 6, 1) : whole;
  const auto upper = beam_part(middle, kBeamLength, 6 * options.finer, options.finer);
  const int first = add_part(builder, "lower", lower, options, true, "x_min");
  const int second = options.cut
                         ? add_part(builder, "upper", upper, options, options.second_fixed, "x_max")
                         : first;
  if (options.cut && options.weld) {
    builder::WeldSettings weld;
    weld.name = "seam";
    weld.first = second;  // the finer one
    weld.second = first;
    weld.nodes = upper->node_sets.at("x_min");
    builder.add_weld(weld);
  }
  for (int k = 0; k < options.cables; ++k) {
    builder::CableSettings cable;
    cable.name = "cable_" + std::to_string(k);
    cable.body = first;
    cable.points.resize(5, 3);
    const double angle = 1.57079632679489662 * k + 0.1;
    for (int i = 0; i < 5; ++i) {
      cable.points.row(i) << (i == 0 ? -0.01 : 0.001 + 0.0245 * i), 0.006 * std::sin(angle),
          0.006 * std::cos(angle);
      cable.point_bodies.push_back(cable.points(i, 0) > middle ? second : first);
    }
    cable.friction = options.cable_friction;
    builder.add_cable(cable);
  }
  builder::EffectorSettings tip;
  tip.name = "tip";
  tip.body = second;
  tip.points.resize(1, 3);
  tip.points << kBeamLength, 0.0, 0.0;
  builder.add_effector(tip);
  if (options.push) {
    builder::ForceSettings push;
    push.name = "push";
    push.body = second;
    push.point = {kBeamLength, 0.005, 0.005};
    push.direction = {0.2, 1.0, -0.5};
    builder.add_force(push);
  }
  if (options.wall) {
    builder::ContactSettings wall;
    wall.name = "wall";
    wall.body = second;
    wall.surface = collision::Plane{{0.0, 0.0, *options.wall}, Vector3::UnitZ()};
    wall.nodes = (options.cut ? upper : whole)->node_sets.at("z_min");
    wall.friction = 0.3;
    builder.add_contact(wall);
  }
  return builder.build();
}

}  // namespace sinew::testing
