// Shallow arches that snap through, shared by tests of path following.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/force_settings.hpp"
#include "sinew/builder/joint_settings.hpp"
#include "sinew/builder/load_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/collision/shape.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/shapes.hpp"

namespace sinew::testing {

inline constexpr double kHalfSpan = 0.05;  // m

/// A shallow arch with clamped ends, pressed down at its crown.
struct ArchOptions {
  bool by_load = true;  ///< by a load of 0.02 N, else by a force actuator at the same point
  /// Whether it is cut into three bodies that are welded together; only welds hold the middle one.
  bool cut = false;
  bool sways = false;  ///< whether the crown may move sideways; the symmetric path then bifurcates
  std::optional<double> floor;            ///< m: z of a plane under the crown
  double friction = 0.0;                  ///< of the plane
  std::optional<collision::Shape> below;  ///< surface in place of the plane
};

// The part of the arch between two values of x.
inline fem::FemBodySettings arch_part(const char* name, double from, double to,
                                      bool sways = false) {
  fem::FemBodySettings body;
  body.name = name;
  mesh::Mesh made =
      mesh::block({.corner = {from, 0.0, 0.0},
                   .size = {to - from, 0.004, 0.002},
                   .cells = {static_cast<int>(std::lround((to - from) / 0.0025)), 1, 2}},
                  mesh::Cells::hexahedra);
  for (Eigen::Index i = 0; i < made.nodes.rows(); ++i) {
    const double x = made.nodes(i, 0) / kHalfSpan;
    made.nodes(i, 2) += 0.008 * 0.5 * (1.0 + std::cos(3.14159265358979 * x));
  }
  const auto mesh = std::make_shared<const mesh::Mesh>(std::move(made));
  body.mesh = mesh;
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(4e4);
  region.hyperelastic->bulk_modulus = 1e5;
  region.density = 1000.0;
  body.elements.regions = {region};
  for (NodeId node = 0; node < static_cast<NodeId>(mesh->nodes.rows()); ++node) {
    const double x = mesh->nodes(node, 0);
    if (std::abs(x) > kHalfSpan - 1e-9) body.elements.fixed_nodes.push_back(node);
    // The crown stays in the middle and one side in its plane, since sway would add branches.
    if (std::abs(x) < 1e-9 && !sways) body.elements.held_axes.push_back({node, 0});
    if (mesh->nodes(node, 1) == 0.0) body.elements.held_axes.push_back({node, 1});
  }
  return body;
}

inline void add_floor(builder::ModelBuilder& builder, int body, const ArchOptions& options) {
  builder::ContactSettings floor;
  floor.name = "floor";
  floor.body = body;
  floor.surface = options.below ? *options.below
                                : collision::Plane{{0.0, 0.0, *options.floor}, Vector3::UnitZ()};
  floor.friction = options.friction;
  const mesh::Mesh& mesh = builder.added_body(body).mesh();
  for (const NodeId node : mesh.node_sets.at("z_min")) {
    if (std::abs(mesh.nodes(node, 0)) < 0.014) floor.nodes.push_back(node);
  }
  builder.add_contact(floor);
}

inline std::shared_ptr<const model::Model> arch(const ArchOptions& options) {
  builder::ModelBuilder builder;
  int middle = 0;
  if (options.cut) {
    const double seam = 0.015;
    const int left = builder.add_body<fem::FemBodyModel>(arch_part("left", -kHalfSpan, -seam));
    middle = builder.add_body<fem::FemBodyModel>(arch_part("middle", -seam, seam));
    const int right = builder.add_body<fem::FemBodyModel>(arch_part("right", seam, kHalfSpan));
    const auto& seams = builder.added_body(middle).mesh().node_sets;
    builder.add_weld(
        {.name = "first", .first = middle, .second = left, .nodes = seams.at("x_min")});
    builder.add_weld(
        {.name = "second", .first = middle, .second = right, .nodes = seams.at("x_max")});
  } else {
    builder.add_body<fem::FemBodyModel>(arch_part("arch", -kHalfSpan, kHalfSpan, options.sways));
  }
  const Vector3 crown(0.0, 0.002, 0.009);
  if (options.by_load) {
    builder.add_load({.name = "press",
                      .body = middle,
                      .load = builder::PointLoadSettings{crown, {0.0, 0.0, -0.02}}});
  } else {
    builder::ForceSettings force;
    force.name = "press";
    force.body = middle;
    force.point = crown;
    force.direction = {0.0, 0.0, -1.0};
    builder.add_force(force);
  }
  if (options.floor || options.below) add_floor(builder, middle, options);
  builder::EffectorSettings top;
  top.name = "crown";
  top.body = middle;
  top.points = crown.transpose();
  builder.add_effector(top);
  return builder.build();
}

}  // namespace sinew::testing
