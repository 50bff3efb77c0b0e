#include "sinew/constraint/effector.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/builder/effector_settings.hpp"
#include "sinew/core/error.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

#include "../sim/robots.hpp"

namespace sinew::constraint {
namespace {

// A block with prescribed node positions.
class Effectors : public ::testing::Test {
 protected:
  Effectors() {
    fem::FemBodySettings body;
    body.name = "block";
    const auto mesh = std::make_shared<const mesh::Mesh>(
        mesh::block({.size = {0.1, 0.1, 0.1}, .cells = {2, 2, 2}}));
    body.mesh = mesh;
    body.elements.regions = {{{1e5, 0.3}, material::Law::corotational, 1000.0, {}}};
    body.elements.fixed_nodes = mesh->node_sets.at("x_min");
    builder_.add_body<fem::FemBodyModel>(std::move(body));
    settings_.name = "e";
    settings_.points.resize(3, 3);
    settings_.points << 0.06, 0.02, 0.03, 0.09, 0.03, 0.02, 0.07, 0.08, 0.05;
  }
  void finish() {
    builder_.add_effector(settings_);
    simulation_ = std::make_unique<sim::Simulation>(builder_.build());
  }
  void place(const Points& positions) {
    std::vector<double> state(simulation_->body(0).state_size());
    simulation_->body(0).save_state(state);
    std::copy_n(positions.data(), positions.size(), state.data());
    simulation_->body(0).load_state(state);
  }
  Points rest() { return simulation_->body(0).model().mesh().nodes; }
  const Effector& effector() { return simulation_->model().effector(0); }

  builder::ModelBuilder builder_;
  builder::EffectorSettings settings_;
  std::unique_ptr<sim::Simulation> simulation_;
};

TEST_F(Effectors, OrientationIsTheRotationVectorOfARigidTurn) {
  settings_.kind = builder::EffectorSettings::Kind::orientation;
  finish();
  const Vector3 turn(0.3, -0.7, 0.5);
  const Matrix3 rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  place(rest() * rotation.transpose());
  EXPECT_LT((effector().value(simulation_->configuration()) - turn).norm(), 1e-12);
}

TEST_F(Effectors, OrientationRowsAreTheSpin) {
  settings_.kind = builder::EffectorSettings::Kind::orientation;
  finish();
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.004);
  Points bent = rest();
  for (Eigen::Index i = 0; i < bent.size(); ++i) bent.data()[i] += noise(random);
  Points direction = bent;
  for (Eigen::Index i = 0; i < direction.size(); ++i) direction.data()[i] = noise(random);
  const double t = 1e-6;
  const auto rotation = [&](double s) {
    place(bent + s * direction);
    const Vector3 v = effector().value(simulation_->configuration());
    return Matrix3(Eigen::AngleAxisd(v.norm(), v.normalized()));
  };
  const Eigen::AngleAxisd spin(rotation(t) * rotation(-t).transpose());
  const Vector3 expected = spin.angle() * spin.axis() / (2 * t);
  place(bent);
  simulation_->world().measure_delta();
  const auto& rows = simulation_->world().rows();
  const auto& pattern = simulation_->model().rows();
  for (int k = 0; k < 3; ++k) {
    double row = 0.0;
    for (int e = pattern.row_start[static_cast<std::size_t>(k)];
         e < pattern.row_start[static_cast<std::size_t>(k) + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const int point = pattern.site[i].number;
      place(bent + t * direction);
      const Vector3 ahead = simulation_->body(0).position(point);
      place(bent - t * direction);
      const Vector3 behind = simulation_->body(0).position(point);
      row += rows.direction[i].dot((ahead - behind) / (2 * t));
    }
    EXPECT_NEAR(row, expected[k], 1e-6 * expected.norm()) << k;
  }
}

TEST_F(Effectors, OrientationTargetIsReachedByTheRemainingTurn) {
  settings_.kind = builder::EffectorSettings::Kind::orientation;
  finish();
  const Vector3 turn(0.0, 0.0, 0.4);
  place(rest() * Matrix3(Eigen::AngleAxisd(0.4, Vector3::UnitZ())).transpose());
  simulation_->world().measure_delta();
  VectorX goal(3);
  effector().target_delta(simulation_->configuration(), Vector3(0.0, 0.0, 1.0), goal);
  EXPECT_LT((goal - simulation_->world().delta() - Vector3(0.0, 0.0, 0.6)).norm(), 1e-12);
}

TEST_F(Effectors, CollinearPointsHaveNoOrientation) {
  settings_.kind = builder::EffectorSettings::Kind::orientation;
  settings_.points << 0.02, 0.02, 0.02, 0.05, 0.05, 0.05, 0.08, 0.08, 0.08;
  try {
    builder_.add_effector(settings_);
    FAIL() << "collinear points were accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::degenerate_orientation);
  }
}

TEST_F(Effectors, SeveralPointsMeanTheirMean) {
  finish();
  const Vector3 mean = settings_.points.colwise().mean().transpose();
  EXPECT_LT((effector().value(simulation_->configuration()) - mean).norm(), 1e-15);
}

TEST_F(Effectors, ChosenDirectionsGiveOneRowEach) {
  settings_.directions.assign(1, Vector3(0, 0, 2));
  finish();
  EXPECT_EQ(effector().row_count(), 1);
  EXPECT_NEAR(simulation_->world().delta()[0], settings_.points.col(2).mean(), 1e-15);
}

}  // namespace
}  // namespace sinew::constraint
