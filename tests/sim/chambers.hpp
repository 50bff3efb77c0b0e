// A block with an internal void, for tests of pressure.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "sinew/builder/chamber_settings.hpp"
#include "sinew/builder/effector_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/quadratic.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::testing {

/// A cube of 30 mm with 3 x 3 x 3 cells, without the middle cell: a void of 10 mm. With `bore`, the
/// cell above it is also missing, so that the void is open at the top.
inline mesh::Mesh hollow_block(mesh::Cells cells, bool bore = false) {
  const auto is_void = [&](const mesh::Mesh& mesh, const auto& element) {
    Vector3 middle = Vector3::Zero();
    for (const NodeId node : element) middle += mesh.nodes.row(node).transpose();
    middle /= static_cast<double>(element.size());
    const bool within = middle.x() > 0.01 && middle.x() < 0.02 && middle.y() > 0.01 &&
                        middle.y() < 0.02 && middle.z() > 0.01;
    return within && (bore || middle.z() < 0.02);
  };
  mesh::Mesh mesh = mesh::block({.size = {0.03, 0.03, 0.03}, .cells = {3, 3, 3}}, cells);
  std::erase_if(mesh.hexahedra, [&](const auto& h) { return is_void(mesh, h); });
  std::erase_if(mesh.tetrahedra, [&](const auto& t) { return is_void(mesh, t); });
  return mesh;
}

inline constexpr double kVoid = 1e-6;  // m^3

struct ChamberOptions {
  model::StepSettings step;
  mesh::Cells cells = mesh::Cells::hexahedra;
  bool quadratic = false;
  bool bore = false;
  bool cap = false;
  bool load_stiffness = true;
  double density = 1000.0;
  std::optional<model::GasSettings> gas;
  std::optional<model::LiquidSettings> liquid;
  fem::RayleighDamping damping;
};

/// The hollow block of neo-Hookean silicone, clamped at its bottom. The void is the actuator
/// `chamber`, and the middle of the top is the effector.
inline std::shared_ptr<const model::Model> chamber(const ChamberOptions& options = {}) {
  builder::ModelBuilder builder(options.step);
  fem::FemBodySettings body;
  body.name = "block";
  const mesh::Mesh linear = hollow_block(options.cells, options.bore);
  const auto mesh = std::make_shared<const mesh::Mesh>(
      options.quadratic ? mesh::with_middle_nodes(linear) : linear);
  body.mesh = mesh;
  body.damping = options.damping;
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(30e3);
  region.hyperelastic->bulk_modulus = material::bulk_modulus_of(30e3, 0.45);
  region.density = options.density;
  body.elements.regions = {region};
  body.elements.fixed_nodes = mesh->node_sets.at("z_min");
  const int number = builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::ChamberSettings chamber;
  chamber.name = "chamber";
  chamber.body = number;
  const Vector3 inside(0.015, 0.015, 0.015);
  chamber.surface =
      options.bore ? mesh::select_faces(
                         *mesh, mesh::BoxRegion{{0.01, 0.01, 0.01}, {0.02, 0.02, 0.03}}, "chamber")
                   : mesh::enclosing_surface(*mesh, inside, "chamber");
  chamber.cap = options.cap;
  chamber.load_stiffness = options.load_stiffness;
  chamber.gas = options.gas;
  chamber.liquid = options.liquid;
  builder.add_chamber(chamber);
  builder::EffectorSettings top;
  top.name = "top";
  top.body = number;
  top.points.resize(1, 3);
  top.points << 0.005, 0.005, 0.03;
  builder.add_effector(top);
  return builder.build();
}

}  // namespace sinew::testing
