// Points on surface triangles, interpolated by the shape functions of the elements below.
#include "sinew/mechanics/surface_trace.hpp"

#include <gtest/gtest.h>

#include "sinew/collision/proximity.hpp"
#include "sinew/mesh/topology.hpp"

#include "solid_bodies.hpp"

namespace sinew::mechanics {
namespace {

using namespace fem::solid_bodies;

// A field that the elements of a kind represent exactly on flat faces along the axes.
Vector3 field(Kind kind, const Vector3& x) {
  const Vector3 linear(1.0 + x[0] - 2.0 * x[1], 3.0 * x[2] - x[0], x[1] + 0.5 * x[2]);
  const Vector3 products(x[0] * x[1], x[1] * x[2], x[2] * x[0]);
  if (kind == Kind::hexahedra) return linear + products;
  return linear;
}

class SurfaceTraces : public testing::TestWithParam<Kind> {};

TEST_P(SurfaceTraces, CarryWhatTheElementsRepresent) {
  const auto mesh = box(GetParam(), 2, 3, 2, 0.0);
  const auto& nodes = mesh->nodes;
  const mesh::Surface surface = mesh::boundary_surface(*mesh);
  const SurfaceTrace trace(mesh::boundary_faces(*mesh), static_cast<int>(nodes.rows()));
  Points values(nodes.rows(), 3);
  for (Eigen::Index k = 0; k < nodes.rows(); ++k) {
    values.row(k) = field(GetParam(), nodes.row(k).transpose()).transpose();
  }
  const Vector3 weights[] = {{1.0, 0.0, 0.0}, {0.3, 0.7, 0.0}, {0.2, 0.5, 0.3}, {0.05, 0.05, 0.9}};
  std::size_t most = 0;
  for (const auto& triangle : surface.triangles) {
    for (const Vector3& share : weights) {
      collision::SurfacePoint place{.weights = share};
      Vector3 x = Vector3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const double part = share[static_cast<Eigen::Index>(k)];
        if (part > 0.0) place.nodes[k] = triangle[k];
        x += part * nodes.row(triangle[k]).transpose();
      }
      const Patch patch = trace.at(place);
      EXPECT_LT((patch.mean(nodes) - x).norm(), 1e-15);
      EXPECT_LT((patch.mean(values) - field(GetParam(), x)).norm(), 1e-14);
      std::size_t used = 0;
      while (used < patch.nodes.size() && patch.nodes[used] >= 0) ++used;
      if (place.nodes[1] < 0) {
        EXPECT_EQ(used, 1U);
      }
      most = std::max(most, used);
    }
  }
  EXPECT_EQ(most, GetParam() == Kind::hexahedra ? 4U : 3U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SurfaceTraces,
                         testing::Values(Kind::tetrahedra, Kind::quadratic, Kind::hexahedra));

}  // namespace
}  // namespace sinew::mechanics
