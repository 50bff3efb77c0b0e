/// @file
/// A block that tests deform to known shapes.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "sinew/builder/model_builder.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/sim/simulation.hpp"

#include "robots.hpp"

namespace sinew::sim {

/// A block along x, with its axis in the middle, fixed at x = 0. Tests add parts to builder_ before
/// they call finish().
struct ShapedBlock {
  static constexpr double kLength = 0.1, kWidth = 0.02;  // m

  ShapedBlock() {
    fem::FemBodySettings body;
    body.name = "block";
    mesh_ = std::make_shared<const mesh::Mesh>(mesh::block(
        {.corner = {0.0, -0.01, -0.01}, .size = {kLength, kWidth, kWidth}, .cells = {10, 2, 2}}));
    body.mesh = mesh_;
    body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
    body.elements.fixed_nodes = mesh_->node_sets.at("x_min");
    builder_.add_body<fem::FemBodyModel>(std::move(body));
  }
  void finish() { simulation_ = std::make_unique<Simulation>(builder_.build()); }
  /// Sets the position of every node to x = move(X).
  template <typename Move>
  void deform(Move&& move) {
    auto& body = simulation_->body(0);
    std::vector<double> state(body.state_size());
    body.save_state(state);
    for (Eigen::Index i = 0; i < mesh_->nodes.rows(); ++i) {
      const Vector3 x = move(Vector3(mesh_->nodes.row(i).transpose()));
      for (Eigen::Index c = 0; c < 3; ++c) state[static_cast<std::size_t>(3 * i + c)] = x[c];
    }
    body.load_state(state);
  }
  /// Bends the axis to an arc in the plane of x and z with the total angle `angle`.
  void bend(double angle) {
    const double radius = kLength / angle;
    deform([=](const Vector3& x) -> Vector3 {
      const double turn = x.x() / radius, distance = radius - x.z();
      return {distance * std::sin(turn), x.y(), radius - distance * std::cos(turn)};
    });
  }

  builder::ModelBuilder builder_;
  std::shared_ptr<const mesh::Mesh> mesh_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace sinew::sim
