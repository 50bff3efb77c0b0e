// The estimate of how much too stiff linear tetrahedra are in bending, against solved cantilevers.
#include "sinew/fem/bending_stiffness.hpp"

#include <cmath>
#include <memory>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "solid_bodies.hpp"

namespace sinew::fem {
namespace {

using namespace solid_bodies;

/// Ratio of the tip deflection of beam theory to that of a mesh of n x n x 5n cells, both under a
/// transverse force at the free end. Theory: F L^3/(3 E I) + F L/(k G A) with k = 5/6 of a
/// rectangle.
double solved_ratio(int n, double nu) {
  const double young = 1e5, length = 5.0 * n * kEdge, width = n * kEdge;
  const auto mesh = block_mesh(n, n, 5 * n, kEdge);
  FemModelSettings settings;
  settings.regions.push_back({.constants = {young, nu}, .density = 1070.0});
  settings.fixed_nodes = bottom_nodes(*mesh, kEdge);
  Body body(mesh, settings);
  VectorX push = VectorX::Zero(3 * body.model->free_count());
  const Eigen::Index end = 3 * (n + 1) * (n + 1);
  for (Eigen::Index k = push.size() - end; k < push.size(); k += 3) push[k] = 3.0 / double(end);
  const double motion = push.dot(body.matrix(mesh->nodes, Tangent::exact).ldlt().solve(push));
  const double inertia = std::pow(width, 4) / 12.0, shear = young / (2.0 * (1.0 + nu));
  const double theory =
      std::pow(length, 3) / (3.0 * young * inertia) + length / (5.0 / 6.0 * shear * width * width);
  return theory / motion;
}

double estimate(int n, double nu) {
  return bending_stiffness_ratio(*block_mesh(n, n, 5 * n, kEdge), nu);
}

// The estimated excess stiffness is within a factor of 1.6 of the true one, which spans 0.3 to 13
// here.
TEST(BendingStiffness, EstimateMeetsSolvedCantilevers) {
  for (const double nu : {0.3, 0.45, 0.49}) {
    for (const int n : {2, 4}) {
      const double excess = (estimate(n, nu) - 1.0) / (solved_ratio(n, nu) - 1.0);
      EXPECT_GT(excess, 1.0 / 1.6) << "nu = " << nu << ", n = " << n;
      EXPECT_LT(excess, 1.6) << "nu = " << nu << ", n = " << n;
    }
  }
}

// The strain error of an interpolated field is proportional to the cell size, its energy to the
// square of it.
TEST(BendingStiffness, ExcessFallsWithTheSquareOfTheCell) {
  for (const double nu : {0.0, 0.45, 0.499}) {
    const double coarse = estimate(2, nu) - 1.0, fine = estimate(4, nu) - 1.0;
    EXPECT_NEAR(coarse / fine, 4.0, 0.3) << "nu = " << nu;
  }
}

TEST(BendingStiffness, DoesNotDependOnPlaceDirectionOrUnit) {
  const auto mesh = block_mesh(2, 3, 12, kEdge, 0.1);
  const double here = bending_stiffness_ratio(*mesh, 0.45);
  const Matrix3 turn = Eigen::AngleAxisd(0.7, Vector3(1.0, -2.0, 0.5).normalized()).matrix();
  mesh->nodes = 1000.0 * (mesh->nodes * turn.transpose()).eval();
  mesh->nodes.rowwise() += Eigen::RowVector3d(5.0, -300.0, 80.0);
  EXPECT_NEAR(bending_stiffness_ratio(*mesh, 0.45), here, 1e-9 * here);
}

}  // namespace
}  // namespace sinew::fem
