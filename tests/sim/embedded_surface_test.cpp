// Chambers whose surface is given apart from the mesh, against the faces of the mesh.
#include "sinew/builder/embedded_surface.hpp"

#include <cmath>
#include <map>
#include <memory>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/constraint/chamber.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/run/state.hpp"

#include "chambers.hpp"
#include "robots.hpp"

namespace sinew::sim {
namespace {

/// A cube of 30 mm with n^3 cells and a void of 10 mm in its middle.
mesh::Mesh block_with_void(int n, mesh::Cells cells) {
  const bool hexahedra = cells == mesh::Cells::hexahedra;
  mesh::Mesh mesh = mesh::block({.size = {0.03, 0.03, 0.03}, .cells = {n, n, n}},
                                hexahedra ? mesh::Cells::hexahedra : mesh::Cells::tetrahedra);
  const auto in_void = [&](const auto& element) {
    Vector3 middle = Vector3::Zero();
    for (const NodeId node : element) middle += mesh.nodes.row(node).transpose();
    middle /= static_cast<double>(element.size());
    return (middle - Vector3::Constant(0.015)).cwiseAbs().maxCoeff() < 0.005;
  };
  std::erase_if(mesh.hexahedra, in_void);
  std::erase_if(mesh.tetrahedra, in_void);
  return cells == mesh::Cells::quadratic ? mesh::with_middle_nodes(mesh) : mesh;
}

using Surfaces = std::variant<std::vector<mesh::Face>, mesh::Surface>;

std::shared_ptr<const model::Model> robot(const mesh::Mesh& mesh, const Surfaces& surface) {
  builder::ModelBuilder builder;
  fem::FemBodySettings body;
  body.name = "block";
  body.mesh = std::make_shared<const mesh::Mesh>(mesh);
  fem::MaterialRegion region;
  region.hyperelastic = material::neo_hookean(30e3);
  region.hyperelastic->bulk_modulus = material::bulk_modulus_of(30e3, 0.45);
  body.elements.regions = {region};
  body.elements.fixed_nodes = mesh.node_sets.at("z_min");
  builder::ChamberSettings chamber;
  chamber.name = "air";
  chamber.body = builder.add_body<fem::FemBodyModel>(std::move(body));
  chamber.surface = surface;
  builder.add_chamber(chamber);
  return builder.build();
}

std::vector<mesh::Face> faces_of_void(const mesh::Mesh& mesh) {
  return mesh::enclosing_surface(mesh, Vector3::Constant(0.015), "void");
}

/// The triangles between the corners of the faces.
mesh::Surface triangles_of_void(const mesh::Mesh& mesh) {
  mesh::Surface surface;
  surface.nodes = mesh.nodes;
  for (const mesh::Face& face : faces_of_void(mesh)) {
    const auto& n = face.node;
    surface.triangles.push_back({n[0], n[1], n[2]});
    if (face.corners() == 4) surface.triangles.push_back({n[0], n[2], n[3]});
  }
  // Only nodes of the surface, as a file has them.
  mesh::Surface result;
  std::map<NodeId, NodeId> number;
  for (const mesh::Triangle& triangle : surface.triangles) {
    for (const NodeId node : triangle) number.try_emplace(node, 0);
  }
  result.nodes.resize(static_cast<Eigen::Index>(number.size()), 3);
  NodeId next = 0;
  for (auto& [node, own] : number) {
    result.nodes.row(next) = mesh.nodes.row(node);
    own = next++;
  }
  for (const auto& [a, b, c] : surface.triangles) {
    result.triangles.push_back({number[a], number[b], number[c]});
  }
  return result;
}

/// The void as twelve triangles, however fine the mesh is.
mesh::Surface coarse_void() {
  mesh::Mesh cube = mesh::block(
      {.corner = Vector3::Constant(0.01), .size = Vector3::Constant(0.01), .cells = {1, 1, 1}});
  return mesh::boundary_surface(cube);
}

/// Every triangle about its centre in three, `times` times: slivers of all sizes.
mesh::Surface slivers(mesh::Surface surface, int times) {
  for (int k = 0; k < times; ++k) {
    std::vector<mesh::Triangle> result;
    for (const auto& [a, b, c] : surface.triangles) {
      const auto centre = static_cast<NodeId>(surface.nodes.rows());
      surface.nodes.conservativeResize(centre + 1, 3);
      surface.nodes.row(centre) =
          (surface.nodes.row(a) + 2.0 * surface.nodes.row(b) + surface.nodes.row(c)) / 4.0;
      result.insert(result.end(), {{a, b, centre}, {b, c, centre}, {c, a, centre}});
    }
    surface.triangles = std::move(result);
  }
  return surface;
}

/// (n, 3): forces of unit pressure on all nodes of the body, with its nodes displaced.
Points forces(const std::shared_ptr<const model::Model>& model, double size, double& growth) {
  Simulation simulation(model);
  run::State state = simulation.state();
  const Points& x = simulation.body(0).positions();
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      state.bodies[0][static_cast<std::size_t>(3 * i + c)] +=
          size * std::sin(150.0 * x(i, (c + 1) % 3) + 240.0 * x(i, c) + c);
    }
  }
  simulation.restore(state);
  mechanics::RowValues values(model->rows());
  const constraint::Chamber& chamber = *model->chamber(0);
  chamber.linearise(simulation.configuration(), values);
  growth = values.delta[0];
  Points result = Points::Zero(x.rows(), 3);
  const auto* elements = mechanics::as<const mechanics::MovesByNodes>(model->body(0));
  for (std::size_t k = 0; k < chamber.material_points().size(); ++k) {
    const auto& at = elements->attachment(chamber.material_points()[k].number);
    for (std::size_t a = 0; a < at.nodes.size(); ++a) {
      result.row(at.nodes[a]) += at.weights[a] * values.direction[k].transpose();
    }
  }
  return result;
}

double inflated(const std::shared_ptr<const model::Model>& model) {
  Simulation simulation(model);
  simulation.command(0, {model::CommandKind::effort, model::Signal::constant(100.0)});
  simulation.solve_static();
  return simulation.actuator(0).motion;
}

class EmbeddedSurfaceTest : public ::testing::TestWithParam<mesh::Cells> {};

// To rounding: vertices weld to nodes, and middles of edges to middle nodes.
TEST_P(EmbeddedSurfaceTest, TrianglesOfTheFacesAreTheFaces) {
  if (GetParam() == mesh::Cells::hexahedra) GTEST_SKIP() << "its faces are bilinear, not flat";
  const mesh::Mesh mesh = block_with_void(6, GetParam());
  double of_faces = 0.0, of_triangles = 0.0;
  const Points expected = forces(robot(mesh, faces_of_void(mesh)), 3e-4, of_faces);
  const Points found = forces(robot(mesh, triangles_of_void(mesh)), 3e-4, of_triangles);
  EXPECT_NEAR(of_triangles, of_faces, 1e-12 * 1e-6);
  EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
}

// With forces at the vertices alone, the coarse surface is off by 16 % and more. Triangles that
// cross elements keep an error of the square of their size.
TEST_P(EmbeddedSurfaceTest, CoarseFineAndIrregularTrianglesInflateAlike) {
  const mesh::Mesh mesh = block_with_void(9, GetParam());
  const double expected = inflated(robot(mesh, faces_of_void(mesh)));
  EXPECT_NEAR(inflated(robot(mesh, coarse_void())), expected, 0.015 * expected);
  EXPECT_NEAR(inflated(robot(mesh, slivers(coarse_void(), 3))), expected, 0.015 * expected);
  EXPECT_NEAR(inflated(robot(mesh, slivers(triangles_of_void(mesh), 2))), expected,
              0.015 * expected);
}

// A closed surface in a rigid translation keeps its volume, so its forces balance.
TEST_P(EmbeddedSurfaceTest, StaysClosedWhereEdgesOfAllLengthsMeet) {
  const mesh::Mesh mesh = block_with_void(3, GetParam());
  double growth = 0.0;
  const Points found = forces(robot(mesh, slivers(coarse_void(), 5)), 5e-4, growth);
  EXPECT_LT(found.colwise().sum().norm(), 1e-12 * found.rowwise().norm().sum());
}

// V is a cubic of the positions: central differences err by h^2/6 of its third derivative.
TEST_P(EmbeddedSurfaceTest, ForcesAreTheDerivativeOfTheVolume) {
  const mesh::Mesh mesh = block_with_void(3, GetParam());
  const auto model = robot(mesh, slivers(coarse_void(), 2));
  double growth = 0.0, up = 0.0, down = 0.0;
  const Points force = forces(model, 5e-4, growth);
  forces(model, 5e-4 + 1e-8, up);
  forces(model, 5e-4 - 1e-8, down);
  Points field(mesh.node_count(), 3);
  for (Eigen::Index i = 0; i < field.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      field(i, c) = std::sin(150.0 * mesh.nodes(i, (c + 1) % 3) + 240.0 * mesh.nodes(i, c) + c);
    }
  }
  const double slope = force.cwiseProduct(field).sum();
  EXPECT_NEAR((up - down) / 2e-8, slope, 1e-6 * force.norm() * field.norm());
}

INSTANTIATE_TEST_SUITE_P(Cells, EmbeddedSurfaceTest,
                         ::testing::Values(mesh::Cells::tetrahedra, mesh::Cells::quadratic,
                                           mesh::Cells::hexahedra));

}  // namespace
}  // namespace sinew::sim
