// What a mesh leaves open does not depend on how it lies in the world.
#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/rotation.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/topology.hpp"

namespace sinew::mesh {
namespace {

/// The mesh turned by a rotation vector and shifted.
Mesh turned(Mesh mesh, const Vector3& by) {
  const Matrix3 rotation = rotation_matrix(by);
  mesh.nodes = moved(mesh.nodes, rotation, {0.3, -0.2, 0.1});
  mesh.axes = rotation * mesh.axes;
  return mesh;
}

const std::vector<Vector3> kTurns = {
    {0.0, 0.0, 0.5 * M_PI}, {M_PI, 0.0, 0.0}, {0.3, -1.2, 0.7}, {2.0, 1.0, -0.4}};

// All faces are squares, whose diagonals are equal.
TEST(TurnedMesh, SplitsSquareFacesTheSameWay) {
  const Mesh mesh =
      block({.corner = {0.0, 0.0, 0.0}, .size = {0.03, 0.02, 0.01}, .cells = {3, 2, 1}},
            Cells::hexahedra);
  for (const Vector3& turn : kTurns) {
    EXPECT_EQ(boundary_surface(turned(mesh, turn)).triangles, boundary_surface(mesh).triangles);
  }
}

// The weights with which the nodes carry a ball around a point.
TEST(TurnedMesh, SpreadsABallTheSameWay) {
  const Mesh mesh =
      block({.corner = {0.0, 0.0, 0.0}, .size = {0.03, 0.02, 0.01}, .cells = {6, 4, 2}},
            Cells::tetrahedra);
  const Vector3 centre(0.0141, 0.0107, 0.0052);
  const EmbeddedPoint before = Embedder(mesh).spread(centre, 0.0043, Outside::error, "guide");
  for (const Vector3& turn : kTurns) {
    const Mesh other = turned(mesh, turn);
    const Vector3 there = rotation_matrix(turn) * centre + Vector3(0.3, -0.2, 0.1);
    const EmbeddedPoint after = Embedder(other).spread(there, 0.0043, Outside::error, "guide");
    ASSERT_EQ(after.nodes, before.nodes);
    for (std::size_t k = 0; k < after.nodes.size(); ++k) {
      EXPECT_NEAR(after.weights[k], before.weights[k], 1e-9);
    }
  }
}

}  // namespace
}  // namespace sinew::mesh
