// Sensor readings of a block with prescribed deformations.
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mesh/patch.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/topology.hpp"
#include "sinew/sense/sensor_settings.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/observables.hpp"

#include "../support/allocation_guard.hpp"
#include "shaped_block.hpp"

namespace sinew::sim {
namespace {

constexpr double kFreeSpace = 8.8541878128e-12;

class SensorBlock : public ::testing::Test, public ShapedBlock {
 protected:
  template <typename What>
  void add(const char* name, What what) {
    sense::SensorSettings settings;
    settings.name = name;
    settings.kind = name;
    settings.what = std::move(what);
    add_sensor(builder_, settings);
  }
  std::vector<double> truth(const char* name) {
    return sense::sensors_of(*simulation_).truth(sense::sensor_index(simulation_->model(), name));
  }
  static Points line(double z) {
    Points corners(2, 3);
    corners << 0.0, 0.0, z, kLength, 0.0, z;
    return corners;
  }
};

TEST_F(SensorBlock, CurvatureOfAnArcIsOneOverItsRadius) {
  // All points are nodes, since elements are straight between them.
  add("axis", sense::SensorCurvature{0, line(0.0), {0.03, 0.05, 0.08}, 0.04, {}});
  add("side", sense::SensorCurvature{0, line(0.01), {0.05}, 0.02, {}});
  finish();
  EXPECT_NEAR(truth("axis")[0], 0.0, 1e-12);
  for (const double angle : {0.4, -1.7, 2.9}) {
    bend(angle);
    for (const double kappa : truth("axis")) {
      EXPECT_NEAR(kappa, std::abs(angle) / kLength, 1e-9) << angle;
    }
    EXPECT_NEAR(truth("side")[0], 1.0 / std::abs(kLength / angle - 0.01), 1e-9);
  }
}

TEST_F(SensorBlock, CurvatureAboutAnAxisHasASign) {
  add("y", sense::SensorCurvature{0, line(0.0), {0.05}, 0.04, Vector3(0.0, 1.0, 0.0)});
  add("x", sense::SensorCurvature{0, line(0.0), {0.05}, 0.04, Vector3(1.0, 0.0, 0.0)});
  finish();
  bend(0.8);  // a rotation from x to z is left-handed about y
  EXPECT_NEAR(truth("y")[0], -0.8 / kLength, 1e-9);
  EXPECT_NEAR(truth("x")[0], 0.0, 1e-9);
  bend(-0.8);
  EXPECT_NEAR(truth("y")[0], 0.8 / kLength, 1e-9);
}

TEST_F(SensorBlock, StrainAndResistanceFollowTheLength) {
  using What = sense::SensorLine::What;
  add("strain", sense::SensorLine{What::stretch, {0, line(0.0), 11}});
  add("gauge", sense::SensorLine{What::resistance, {0, line(0.0), 11}, 2.1, 350.0});
  finish();
  EXPECT_NEAR(truth("gauge")[0], 350.0, 1e-9);
  deform([](const Vector3& x) -> Vector3 { return {1.25 * x.x(), 0.9 * x.y(), 0.9 * x.z()}; });
  EXPECT_NEAR(truth("strain")[0], 0.25, 1e-12);
  EXPECT_NEAR(truth("gauge")[0], 350.0 * (1.0 + 2.1 * 0.25), 1e-9);
}

TEST_F(SensorBlock, LightIsLostByLengthAndTurn) {
  add("light", sense::SensorLine{
                   sense::SensorLine::What::attenuation, {0, line(0.0), 11}, 0.0, 0.0, 20.0, 1.5});
  finish();
  EXPECT_NEAR(truth("light")[0], 20.0 * kLength, 1e-12);
  const double angle = 1.2, piece = angle / 10;
  bend(angle);
  const double chords = 10 * 2.0 * (kLength / angle) * std::sin(0.5 * piece);
  EXPECT_NEAR(truth("light")[0], 20.0 * chords + 1.5 * 9 * piece, 1e-9);
}

// Nanson's formula: da n = J F^-T dA N. The volume of a layer between parallel plates is J A d.
TEST_F(SensorBlock, CapacitanceOfPlatesIsThatOfAnAffineLayer) {
  const auto faces = [&](const char* set) {
    return mesh::select_faces(*mesh_, mesh::NamedRegion{set}, set);
  };
  add("plates", sense::SensorCapacitance{{{{0, faces("z_min")}, {0, faces("z_max")}}}, 2.8});
  finish();
  const double at_rest = 2.8 * kFreeSpace * kLength * kWidth / kWidth;
  EXPECT_NEAR(truth("plates")[0], at_rest, 1e-9 * at_rest);
  std::vector<Matrix3> gradients(3, Matrix3::Identity());
  gradients[0].diagonal() << 1.4, 0.9, 0.8;
  gradients[1](0, 2) = 0.7;  // shear moves the plates parallel to each other
  gradients[2] << 1.1, 0.2, -0.3, 0.1, 0.9, 0.2, 0.05, -0.1, 1.2;
  for (const Matrix3& f : gradients) {
    deform([&](const Vector3& x) -> Vector3 { return f * x; });
    const Vector3 area = f.determinant() * f.inverse().transpose() * Vector3::UnitZ();
    const double expected = at_rest * area.squaredNorm() / f.determinant();
    EXPECT_NEAR(truth("plates")[0], expected, 1e-9 * expected);
  }
}

TEST_F(SensorBlock, MarkersAndOrientationsFollowARigidMotion) {
  Points frame(3, 3);
  frame << 0.09, 0.0, 0.0, 0.1, 0.0, 0.0, 0.09, 0.01, 0.0;
  add("marker", sense::SensorMarker{{0, {}, mesh_->node_sets.at("x_max")}});
  add("imu", sense::SensorMotion{sense::SensorMotion::What::orientation, 0, frame, {}});
  add("level",
      sense::SensorMotion{sense::SensorMotion::What::accelerometer, 0, frame, {0.0, 0.0, -9.81}});
  finish();
  const Vector3 turn(0.4, -0.9, 0.3);
  const Matrix3 r = rotation_matrix(turn);
  deform([&](const Vector3& x) -> Vector3 { return r * x + Vector3(0.1, 0.2, 0.3); });
  Vector3 mean = Vector3::Zero();
  for (const NodeId node : mesh_->node_sets.at("x_max")) {
    mean += mesh_->nodes.row(node).transpose() /
            static_cast<double>(mesh_->node_sets.at("x_max").size());
  }
  const Vector3 place = r * mean + Vector3(0.1, 0.2, 0.3), up = r.transpose() * Vector3(0, 0, 9.81);
  for (Eigen::Index c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    EXPECT_NEAR(truth("marker")[k], place[c], 1e-12);
    EXPECT_NEAR(truth("imu")[k], turn[c], 1e-9);
    EXPECT_NEAR(truth("level")[k], up[c], 1e-9);
  }
}

TEST_F(SensorBlock, SamplingAndReadingAllocateNothing) {
  Points frame(3, 3);
  frame << 0.09, 0.0, 0.0, 0.1, 0.0, 0.0, 0.09, 0.01, 0.0;
  using What = sense::SensorMotion::What;
  add("marker", sense::SensorMarker{{0, {}, mesh_->node_sets.at("x_max")}});
  add("spin", sense::SensorMotion{What::gyroscope, 0, frame, {}});
  add("shake", sense::SensorMotion{What::accelerometer, 0, frame, {}});
  add("axis", sense::SensorCurvature{0, line(0.0), {0.03, 0.05, 0.08}, 0.04, {}});
  add("strain", sense::SensorLine{sense::SensorLine::What::stretch, {0, line(0.0), 11}});
  finish();
  Observables list(*simulation_);
  const auto read = [&] {
    list.refresh();
    for (std::size_t k = 0; k < list.list().size(); ++k) {
      if (list.list()[k].kind == run::ObservableKind::sensor) list.read(k);
    }
  };
  for (int k = 0; k < 3; ++k) simulation_->step();
  read();
  const long before = testing::allocations();
  for (int k = 0; k < 3; ++k) {
    simulation_->step();
    read();
  }
  if (testing::counts_allocations()) {
    EXPECT_EQ(testing::allocations(), before);
  }
}

TEST_F(SensorBlock, RefusesWhatLiesBeyondItsLine) {
  EXPECT_THROW(add("end", sense::SensorCurvature{0, line(0.0), {0.099}, 0.02, {}}), Error);
  EXPECT_THROW(
      add("point", sense::SensorLine{sense::SensorLine::What::stretch, {0, Points::Zero(2, 3), 5}}),
      Error);
  add("one", sense::SensorCurvature{0, line(0.0), {0.05}, 0.02, {}});
  EXPECT_THROW(add("one", sense::SensorCurvature{0, line(0.0), {0.05}, 0.02, {}}), Error);
}

}  // namespace
}  // namespace sinew::sim
