#include <random>

#include <gtest/gtest.h>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/shape_contact.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/simulation.hpp"

#include "../sim/robots.hpp"

namespace sinew::constraint {
namespace {

std::vector<collision::Shape> surfaces() {
  return {Plane{{0.1, -0.2, 0.05}, Vector3(0.3, -0.4, 0.8).normalized()},
          Sphere{{0.02, 0.01, -0.03}, 0.02},
          Capsule{{-0.01, 0.0, 0.0}, {0.03, 0.02, -0.01}, 0.005}};
}

/// A point of a bent beam near a ball that moves and rotates in the step.
class ContactRows : public ::testing::Test {
 protected:
  ContactRows() : model_(sinew::testing::beam()), simulation_(model_) {}

  static Eigen::Isometry3d pose(double time) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.rotate(Eigen::AngleAxisd(0.3 * time, Vector3(0.2, 0.5, 0.7).normalized()));
    pose.pretranslate(Vector3(0.004 * time, -0.002 * time, 0.001));
    return pose;
  }
  void shift(double t) {
    auto& body = simulation_.body(0);
    std::mt19937 random(11);
    std::normal_distribution<double> noise;
    std::vector<double> state(body.state_size());
    body.save_state(state);
    for (std::size_t i = 0; i < state.size() / 2; ++i) state[i] += t * noise(random);
    body.load_state(state);
  }

  std::shared_ptr<const model::Model> model_;
  sim::Simulation simulation_;
};

TEST_F(ContactRows, AreTheDerivativeOfGapAndSlip) {
  const auto& effector = dynamic_cast<const PointEffector&>(model_->effector(0));
  for (const collision::Shape& surface : surfaces()) {
    ShapeContact contact("contact", std::vector{effector.point()}, surface, 0.5);
    mechanics::RowPattern pattern;
    std::vector<mechanics::StiffnessPair> stiffness_pairs;
    contact.declare(pattern, stiffness_pairs);
    mechanics::RowValues values;
    values.resize(pattern);
    const Configuration& configuration = simulation_.configuration();
    contact.begin_step(configuration, pose(1.0), pose(1.5), 0.0, values);
    contact.linearise(configuration, values);
    const VectorX before = values.delta;
    const Vector3 at = configuration.position(effector.point());
    const double gap = contact.gap_now(configuration, pose(1.5), 0, values);
    const double t = 1e-6;
    shift(t);
    contact.linearise(configuration, values);
    const Vector3 moved = configuration.position(effector.point()) - at;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR((values.delta[k] - before[k]) / t,
                  values.direction[static_cast<std::size_t>(k)].dot(moved) / t, 1e-8);
    }
    // The gap row equals the exact gap to second order in the point's motion relative to the
    // surface.
    const double carried = (at - pose(1.5) * pose(1.0).inverse() * at).norm();
    EXPECT_NEAR(before[0], gap, carried * carried / 0.005);
    shift(-t);
  }
}

// The contact frame of a step is that of the path at the point's velocity; row values and positions
// are consistent in it.
TEST_F(ContactRows, FrameIsThatOfTheWay) {
  const auto& effector = dynamic_cast<const PointEffector&>(model_->effector(0));
  const Configuration& configuration = simulation_.configuration();
  auto& body = simulation_.body(0);
  std::vector<double> state(body.state_size());
  body.save_state(state);
  for (std::size_t i = state.size() / 2; i < state.size(); i += 3) state[i] = 1.0;  // along x
  body.load_state(state);
  const Vector3 at = configuration.position(effector.point());
  const Sphere ball{at + Vector3(0.05, 0.0, -0.0051), 0.005};
  ShapeContact contact("contact", std::vector{effector.point()}, ball, 0.5);
  mechanics::RowPattern pattern;
  std::vector<mechanics::StiffnessPair> stiffness_pairs;
  contact.declare(pattern, stiffness_pairs);
  mechanics::RowValues values;
  values.resize(pattern);
  const Eigen::Isometry3d rest = Eigen::Isometry3d::Identity();
  contact.begin_step(configuration, rest, rest, 0.1, values);
  EXPECT_LT((values.direction[0] - Vector3::UnitZ()).norm(), 1e-9);  // along the path
  EXPECT_NEAR(values.reference[0], 1e-4, 1e-12);
  for (const Vector3& point : {at, Vector3(0.3, -0.2, 0.1)}) {
    const Vector3 rows = contact.row_values(0, point, values);
    EXPECT_LT((contact.position(0, rows, values) - point).norm(), 1e-15);
  }
  contact.begin_step(configuration, rest, rest, 0.0, values);  // at rest
  EXPECT_LT(values.direction[0][0], -0.9);
}

TEST_F(ContactRows, PointThatTheSurfaceCarriesDoesNotSlip) {
  const auto& effector = dynamic_cast<const PointEffector&>(model_->effector(0));
  ShapeContact contact("contact", std::vector{effector.point()}, Sphere{{0.1, 0.0, 0.03}, 0.03},
                       0.5);
  mechanics::RowPattern pattern;
  std::vector<mechanics::StiffnessPair> stiffness_pairs;
  contact.declare(pattern, stiffness_pairs);
  mechanics::RowValues values;
  values.resize(pattern);
  auto& body = simulation_.body(0);
  const Configuration& configuration = simulation_.configuration();
  contact.begin_step(configuration, pose(0.0), pose(2.0), 0.0, values);
  std::vector<double> state(body.state_size());
  body.save_state(state);
  const Eigen::Isometry3d carry = pose(2.0) * pose(0.0).inverse();
  for (std::size_t i = 0; i + 2 < state.size() / 2; i += 3) {
    const Vector3 moved = carry * Vector3(state[i], state[i + 1], state[i + 2]);
    for (std::size_t c = 0; c < 3; ++c) state[i + c] = moved[static_cast<int>(c)];
  }
  body.load_state(state);
  contact.linearise(configuration, values);
  EXPECT_NEAR(values.delta[0], values.reference[0], 1e-14);
  EXPECT_NEAR(values.delta[1], 0.0, 1e-14);
  EXPECT_NEAR(values.delta[2], 0.0, 1e-14);
}

TEST(Contact, RefusesBadFrictionAndNoPoints) {
  EXPECT_THROW(ShapeContact("c", std::vector<mechanics::MaterialPoint>{{0, 0}}, Plane{}, -0.1),
               Error);
  EXPECT_THROW(ShapeContact("c", std::vector<mechanics::MaterialPoint>{}, Plane{}, 0.1), Error);
}

}  // namespace
}  // namespace sinew::constraint
