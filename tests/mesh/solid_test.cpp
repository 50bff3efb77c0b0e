#include "sinew/mesh/solid.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/mesh/shapes.hpp"
#include "sinew/mesh/topology.hpp"

#include "support.hpp"

namespace sinew::mesh {
namespace {

using test::error_text;

Surface box(const Vector3& corner, const Vector3& edges) {
  return boundary_surface(
      block({.corner = corner, .size = edges, .cells = {2, 3, 1}}, Cells::tetrahedra));
}

void expect_near(const Matrix3& one, const Matrix3& other, double bound) {
  EXPECT_LE((one - other).cwiseAbs().maxCoeff(), bound) << one << "\n\n" << other;
}

TEST(SolidMoments, OfABox) {
  const Vector3 corner(3.0, -20.0, 0.5), edges(0.6, 0.4, 0.2);
  const SolidMoments moments = solid_moments(box(corner, edges));
  EXPECT_NEAR(moments.volume, 0.048, 1e-15);
  EXPECT_LE((moments.centre - corner - 0.5 * edges).norm(), 1e-14);
  const Matrix3 second = 0.048 / 12.0 * Matrix3(edges.cwiseAbs2().asDiagonal());
  expect_near(moments.second, second, 1e-12 * second.maxCoeff());
}

// Integrals over the unit simplex: x 1/24, x^2 1/60, x y 1/120.
TEST(SolidMoments, OfATetrahedronUnderAnyLinearMap) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const Surface unit = boundary_surface(test::one_tetrahedron());  // edges of 0.1
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix3 map = Matrix3::NullaryExpr([&] { return number(random); });
    const Vector3 shift = Vector3::NullaryExpr([&] { return number(random); });
    Surface surface = unit;
    surface.nodes = 10.0 * unit.nodes * map.transpose();
    surface.nodes.rowwise() += shift.transpose();
    const double volume = map.determinant() / 6.0;
    const Vector3 centre = Vector3::Constant(0.25);
    const Matrix3 about_corner = Matrix3::Constant(1.0 / 120.0) + Matrix3::Identity() / 120.0;
    const Matrix3 second = about_corner - centre * centre.transpose() / 6.0;
    const SolidMoments moments = solid_moments(surface);
    EXPECT_NEAR(moments.volume, volume, 1e-15);
    if (std::abs(volume) < 1e-3) continue;
    EXPECT_LE((moments.centre - map * centre - shift).norm(), 1e-12);
    expect_near(moments.second, map.determinant() * map * second * map.transpose(), 1e-15);
  }
}

TEST(SolidMoments, AddUp) {
  // A box cut in two has the sum of its parts' moments, shifted to the common centre.
  const SolidMoments whole = solid_moments(box({0, 0, 0}, {3, 1, 2}));
  const SolidMoments left = solid_moments(box({0, 0, 0}, {1, 1, 2}));
  const SolidMoments right = solid_moments(box({1, 0, 0}, {2, 1, 2}));
  Matrix3 sum = left.second + right.second;
  for (const SolidMoments* part : {&left, &right}) {
    const Vector3 arm = part->centre - whole.centre;
    sum += part->volume * arm * arm.transpose();
  }
  expect_near(whole.second, sum, 1e-13);
}

TEST(RequireSolid, NamesWhatIsNone) {
  Surface good = box({0, 0, 0}, {1, 1, 1});
  require_solid(good);
  Surface open = good;
  open.triangles.pop_back();
  error_text(ErrorKind::surface_not_closed, [&] { require_solid(open); });
  Surface inside_out = good;
  for (Triangle& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  error_text(ErrorKind::inverted_element, [&] { require_solid(inside_out); });
  Surface flat = good;
  flat.nodes.col(2).setZero();
  error_text(ErrorKind::zero_volume, [&] { require_solid(flat); });
  Surface crossing = good;
  const Surface other = box({0.3, 0.2, 0.4}, {1, 1, 1});
  const auto first = static_cast<NodeId>(good.nodes.rows());
  crossing.nodes.conservativeResize(2 * first, 3);
  crossing.nodes.bottomRows(first) = other.nodes;
  for (const auto& [a, b, c] : other.triangles) {
    crossing.triangles.push_back({first + a, first + b, first + c});
  }
  error_text(ErrorKind::self_crossing, [&] { require_solid(crossing); });
}

}  // namespace
}  // namespace sinew::mesh
