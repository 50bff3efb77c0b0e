#include "sinew/constraint/chamber.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/fem/has_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "../sim/chambers.hpp"
#include "support/error_kind.hpp"

namespace sinew::constraint {
namespace {

using sinew::testing::chamber;
using sinew::testing::kVoid;

/// A chamber whose node positions are prescribed.
enum class Kind { tetrahedra, quadratic, hexahedra };

sinew::testing::ChamberOptions options_of(Kind kind) {
  sinew::testing::ChamberOptions options;
  options.cells = kind == Kind::hexahedra ? mesh::Cells::hexahedra : mesh::Cells::tetrahedra;
  options.quadratic = kind == Kind::quadratic;
  return options;
}

class ChamberTest : public ::testing::TestWithParam<Kind> {
 protected:
  ChamberTest() : simulation_(chamber(options_of(GetParam()))) {}

  const Chamber& held_chamber() { return *simulation_.model().chamber(0); }
  mechanics::RowValues rows() {
    mechanics::RowValues values;
    values.resize(simulation_.model().rows());
    held_chamber().linearise(simulation_.configuration(), values);
    return values;
  }
  /// Displaces the nodes by a smooth field of this magnitude, m.
  void distort(double size) {
    run::State state = simulation_.state();
    const Points& x = simulation_.body(0).positions();
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      state.bodies[0][static_cast<std::size_t>(3 * i)] +=
          size * std::sin(100.0 * x(i, 1) + 40.0 * x(i, 2));
      state.bodies[0][static_cast<std::size_t>(3 * i + 1)] += size * std::cos(130.0 * x(i, 0));
      state.bodies[0][static_cast<std::size_t>(3 * i + 2)] +=
          size * std::sin(90.0 * x(i, 0) - x(i, 1));
    }
    simulation_.restore(state);
  }
  void move(const mechanics::MaterialPoint& point, int axis, double by) {
    run::State state = simulation_.state();
    const auto* model = mechanics::as<const mechanics::MovesByNodes>(simulation_.model().body(0));
    const NodeId node = model->attachment(point.number).nodes.front();
    state.bodies[0][static_cast<std::size_t>(3 * node + axis)] += by;
    simulation_.restore(state);
  }

  sim::Simulation simulation_;
};

TEST_P(ChamberTest, VolumeOfACubeIsExact) {
  EXPECT_NEAR(held_chamber().rest_volume(), kVoid, 1e-18);
  EXPECT_NEAR(held_chamber().rest_area(), 6e-4, 1e-15);
  EXPECT_DOUBLE_EQ(rows().delta[0], 0.0);
}

TEST_P(ChamberTest, PressurePutsNoForceAndNoMomentOnTheWhole) {
  distort(1e-3);
  const auto values = rows();
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  double size = 0.0;
  for (std::size_t k = 0; k < held_chamber().material_points().size(); ++k) {
    const Vector3 x = simulation_.configuration().position(held_chamber().material_points()[k]);
    force += values.direction[k];
    moment += x.cross(values.direction[k]);
    size += values.direction[k].norm();
  }
  EXPECT_GT(size, 1e-4);
  EXPECT_LT(force.norm(), 1e-14 * size);
  EXPECT_LT(moment.norm(), 1e-16 * size);
}

TEST_P(ChamberTest, DirectionsAreTheDerivativeOfTheVolume) {
  distort(1e-3);
  const auto exact = rows();
  constexpr double kStep = 1e-5;
  for (std::size_t k = 0; k < held_chamber().material_points().size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      move(held_chamber().material_points()[k], axis, kStep);
      const double up = rows().delta[0];
      move(held_chamber().material_points()[k], axis, -2.0 * kStep);
      const double down = rows().delta[0];
      move(held_chamber().material_points()[k], axis, kStep);
      // V is linear in each coordinate, so central differences are exact up to rounding.
      EXPECT_NEAR(exact.direction[k][axis], (up - down) / (2.0 * kStep), 1e-12) << k;
    }
  }
}

TEST_P(ChamberTest, HessianIsTheDerivativeOfTheDirections) {
  distort(1e-3);
  auto pairs = simulation_.model().stiffness_pairs();
  const std::vector<double> effort{1.0};
  held_chamber().geometric_stiffness(simulation_.configuration(), effort, pairs);
  const auto& points = held_chamber().material_points();
  const auto index = [&](const mechanics::MaterialPoint& wanted) {
    std::size_t k = 0;
    while (points[k].number != wanted.number) ++k;
    return k;
  };
  ASSERT_EQ(static_cast<int>(pairs.size()), held_chamber().stiffness_pair_count());
  constexpr double kStep = 1e-5;
  double largest = 0.0;
  for (const auto& pair : pairs) {
    const std::size_t first = index(pair.first);
    for (int axis = 0; axis < 3; ++axis) {
      move(pair.second, axis, kStep);
      const Vector3 up = rows().direction[first];
      move(pair.second, axis, -2.0 * kStep);
      const Vector3 down = rows().direction[first];
      move(pair.second, axis, kStep);
      const Vector3 column = (up - down) / (2.0 * kStep);
      EXPECT_LT((pair.hessian.col(axis) - column).norm(), 1e-10);
      largest = std::max(largest, column.norm());
    }
  }
  EXPECT_GT(largest, 1e-3);
}

TEST_P(ChamberTest, LoadStiffnessOfAClosedSurfaceNeedsNoWiderPattern) {
  EXPECT_FALSE(simulation_.model().geometric_stiffness().extends_pattern);
  EXPECT_EQ(simulation_.model().geometric_stiffness().in_steps.size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ChamberTest,
                         ::testing::Values(Kind::tetrahedra, Kind::quadratic, Kind::hexahedra));

using sinew::testing::kind_of;

// On a flat quadratic triangle the corners carry no load and the middle nodes a third each.
TEST(Chamber, PressureOnFlatQuadraticFacesIsConsistent) {
  const sim::Simulation simulation(chamber(options_of(Kind::quadratic)));
  const Chamber& chamber = *simulation.model().chamber(0);
  mechanics::RowValues values;
  values.resize(simulation.model().rows());
  chamber.linearise(simulation.configuration(), values);
  std::vector<double> share(chamber.material_points().size(), 0.0);
  double area = 0.0;
  for (const ChamberFace& face : chamber.faces()) {
    for (const int middle : face.middle) share[static_cast<std::size_t>(middle)] += 0.5e-4 / 3.0;
    area += 0.5e-4;
  }
  EXPECT_NEAR(area, 6e-4, 1e-12);
  for (std::size_t k = 0; k < share.size(); ++k) {
    // Middle nodes on an edge of the cube take load from two sides, those within a face from one.
    const double found = values.direction[k].cwiseAbs().sum();
    EXPECT_NEAR(found, share[k], 1e-15) << k;
  }
}

TEST(Chamber, OpenSurfacesAreRefusedOrCapped) {
  EXPECT_EQ(kind_of([] { chamber({.bore = true}); }), ErrorKind::surface_not_closed);
  const auto capped = chamber({.bore = true, .cap = true});
  EXPECT_NEAR(capped->chamber(0)->rest_volume(), 2.0 * kVoid, 1e-17);
}

TEST_P(ChamberTest, ACapPassesItsForceToTheRim) {
  auto options = options_of(GetParam());
  options.bore = options.cap = true;
  sim::Simulation simulation(chamber(options));
  run::State state = simulation.state();
  for (std::size_t k = 0; k < state.bodies[0].size() / 2; ++k) {
    state.bodies[0][k] += 2e-4 * std::sin(37.0 * static_cast<double>(k));
  }
  simulation.restore(state);
  mechanics::RowValues values;
  values.resize(simulation.model().rows());
  simulation.model().chamber(0)->linearise(simulation.configuration(), values);
  Vector3 force = Vector3::Zero();
  double size = 0.0;
  for (const Vector3& direction : values.direction) {  // the effector's directions are not formed
    force += direction;
    size += direction.norm();
  }
  EXPECT_GT(size, 1e-4);
  EXPECT_LT(force.norm(), 1e-14 * size);
}

TEST(Chamber, PointsThatEncloseNothingAreRefused) {
  const mesh::Mesh mesh = sinew::testing::hollow_block(mesh::Cells::hexahedra);
  EXPECT_EQ(mesh::enclosing_surface(mesh, {0.015, 0.015, 0.015}, "x").size(), 6U);
  for (const Vector3& at : {Vector3(0.005, 0.005, 0.005), Vector3(0.015, 0.015, 0.05)}) {
    EXPECT_EQ(kind_of([&] { mesh::enclosing_surface(mesh, at, "x"); }), ErrorKind::empty_region);
  }
}

/// Near a corner of the void, the thin wall's outer faces have nearer centres than the void's own.
TEST(Chamber, AVoidIsFoundFromItsCornersToo) {
  mesh::Mesh mesh = sinew::testing::hollow_block(mesh::Cells::hexahedra);
  mesh.nodes = mesh.nodes.cwiseMax(0.009);
  EXPECT_EQ(mesh::enclosing_surface(mesh, {0.011, 0.011, 0.011}, "x").size(), 6U);
}

TEST(Chamber, APatchGrowsOverBluntEdgesAlone) {
  const mesh::Mesh mesh =
      mesh::block({.size = {0.03, 0.03, 0.03}, .cells = {3, 3, 3}}, mesh::Cells::hexahedra);
  EXPECT_EQ(mesh::grow_patch(mesh, {0.015, 0.015, 0.03}, 0.5, "x").size(), 9U);
  EXPECT_EQ(mesh::grow_patch(mesh, {0.015, 0.015, 0.03}, 1.6, "x").size(), 54U);
  EXPECT_EQ(kind_of([&] { mesh::grow_patch(mesh, Vector3::Zero(), 0.0, "x"); }),
            ErrorKind::out_of_range);
}

}  // namespace
}  // namespace sinew::constraint
