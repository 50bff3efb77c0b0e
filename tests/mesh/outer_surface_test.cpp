// The drawn part of a mesh: surface triangles with the element behind each, and an interior that
// fills the surface.
#include "sinew/mesh/outer_surface.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/mesh/quality.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/solid.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {
namespace {

/// Nodes of each element: tetrahedra with their middle nodes, then hexahedra.
std::vector<std::vector<NodeId>> elements_of(const Mesh& mesh) {
  std::vector<std::vector<NodeId>> result;
  for (const auto& nodes : mesh.quadratic) result.emplace_back(nodes.begin(), nodes.end());
  if (mesh.quadratic.empty()) {
    for (const auto& nodes : mesh.tetrahedra) result.emplace_back(nodes.begin(), nodes.end());
  }
  for (const auto& nodes : mesh.hexahedra) result.emplace_back(nodes.begin(), nodes.end());
  return result;
}

/// (vertices, 3): positions of the vertices for node positions x.
Points vertices_at(const OuterSurface& surface, const Interior& inside, const Points& x) {
  std::vector<Vector3> list;
  for (const NodeId node : surface.nodes) list.emplace_back(x.row(node).transpose());
  for (const NodeId node : inside.nodes) list.emplace_back(x.row(node).transpose());
  for (const Hexahedron& nodes : inside.hexahedra) {
    Vector3 sum = Vector3::Zero();
    for (const NodeId node : nodes) sum += x.row(node).transpose();
    list.emplace_back(sum / 8.0);
  }
  Points result(static_cast<Eigen::Index>(list.size()), 3);
  for (std::size_t k = 0; k < list.size(); ++k) {
    result.row(static_cast<Eigen::Index>(k)) = list[k].transpose();
  }
  return result;
}

/// Volume of each tetrahedron, m^3.
std::vector<double> volumes(const Interior& inside, const Points& x) {
  std::vector<double> result;
  for (std::size_t t = 0; t < inside.elements.size(); ++t) {
    Corners corners;
    for (std::size_t k = 0; k < 4; ++k) {
      corners[k] = x.row(static_cast<Eigen::Index>(inside.tetrahedra[4 * t + k])).transpose();
    }
    result.push_back(signed_volume(corners));
  }
  return result;
}

class OuterSurfaceOf : public testing::TestWithParam<Cells> {};

TEST_P(OuterSurfaceOf, HasTheTrianglesAndTheElementsBehindThem) {
  const Mesh mesh = cylinder({.radius = 0.01, .height = 0.03, .rings = 3, .layers = 4}, GetParam());
  const OuterSurface surface = outer_surface(mesh);
  const std::vector<Triangle> triangles = boundary_surface(mesh).triangles;
  const auto elements = elements_of(mesh);
  ASSERT_EQ(surface.triangles.size(), 3 * triangles.size());
  ASSERT_EQ(surface.elements.size(), triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(surface.nodes[surface.triangles[3 * t + k]], triangles[t][k]);
      ASSERT_TRUE(std::ranges::count(elements.at(static_cast<std::size_t>(surface.elements[t])),
                                     triangles[t][k]));
    }
  }
}

// Divergence theorem: if the tetrahedra have neither gaps nor overlaps, their total volume equals
// the volume enclosed by the surface, for arbitrary node positions.
TEST_P(OuterSurfaceOf, IsFilledByItsInteriorHoweverNodesMove) {
  const Mesh mesh = cylinder({.radius = 0.01, .height = 0.03, .rings = 3, .layers = 4}, GetParam());
  const OuterSurface surface = outer_surface(mesh);
  const Interior inside = interior(mesh, surface);
  ASSERT_EQ(inside.tetrahedra.size(), 4 * inside.elements.size());
  EXPECT_EQ(surface.nodes.size() + inside.nodes.size(),
            static_cast<std::size_t>(mesh.node_count()));
  EXPECT_GT(inside.nodes.size(), 0U);
  for (const double volume : volumes(inside, vertices_at(surface, inside, mesh.nodes))) {
    EXPECT_GT(volume, 0.0);
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> away(-1e-3, 1e-3);
  for (int k = 0; k < 3; ++k) {
    const Points moved =
        mesh.nodes + Points::NullaryExpr(mesh.nodes.rows(), 3, [&] { return away(random); });
    double sum = 0.0;
    for (const double volume : volumes(inside, vertices_at(surface, inside, moved))) sum += volume;
    Surface outside = boundary_surface(mesh);
    outside.nodes = moved;
    const double within = solid_moments(outside).volume;
    EXPECT_NEAR(sum, within, 1e-12 * within);
  }
}

TEST_P(OuterSurfaceOf, HasTetrahedraBetweenTheNodesOfTheirElement) {
  const Mesh mesh = block({.cells = {3, 3, 3}}, GetParam());
  const OuterSurface surface = outer_surface(mesh);
  const Interior inside = interior(mesh, surface);
  const auto elements = elements_of(mesh);
  const Points x = vertices_at(surface, inside, mesh.nodes);
  std::vector<double> volume(elements.size(), 0.0);
  const std::vector<double> parts = volumes(inside, x);
  for (std::size_t t = 0; t < parts.size(); ++t) {
    volume[static_cast<std::size_t>(inside.elements[t])] += parts[t];
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t vertex = inside.tetrahedra[4 * t + k], outer = surface.nodes.size();
      if (vertex >= outer + inside.nodes.size()) continue;  // a centre vertex
      const NodeId node = vertex < outer ? surface.nodes[vertex] : inside.nodes[vertex - outer];
      ASSERT_TRUE(std::ranges::count(elements[static_cast<std::size_t>(inside.elements[t])], node));
    }
  }
  const double whole = solid_moments(boundary_surface(mesh)).volume;
  for (const double v : volume) {
    EXPECT_NEAR(v, whole / static_cast<double>(volume.size()), 1e-12 * whole);
  }
}

INSTANTIATE_TEST_SUITE_P(Cells, OuterSurfaceOf,
                         testing::Values(Cells::tetrahedra, Cells::quadratic, Cells::hexahedra));

TEST(OuterSurface, OfTrianglesAloneHasNoElements) {
  Mesh mesh;
  mesh.nodes = Points::Identity(4, 3);
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
  const OuterSurface surface = outer_surface(mesh);
  EXPECT_EQ(surface.elements, (std::vector<std::int32_t>{-1, -1}));
  const Interior inside = interior(mesh, surface);
  EXPECT_TRUE(inside.tetrahedra.empty() && inside.nodes.empty());
}

}  // namespace
}  // namespace sinew::mesh
