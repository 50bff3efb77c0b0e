#include "sinew/constraint/contact.hpp"

#include <random>

#include <gtest/gtest.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/placement.hpp"
#include "sinew/core/error.hpp"

#include "../sim/robots.hpp"

namespace sinew::constraint {
namespace {

std::vector<Surface> surfaces() {
  return {Plane{{0.1, -0.2, 0.05}, Vector3(0.3, -0.4, 0.8).normalized()},
          Sphere{{0.02, 0.01, -0.03}, 0.02},
          Capsule{{-0.01, 0.0, 0.0}, {0.03, 0.02, -0.01}, 0.005}};
}

TEST(Surface, NormalIsTheGradientOfTheGap) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-0.1, 0.1);
  constexpr double kStep = 1e-7;
  for (const Surface& surface : surfaces()) {
    for (int trial = 0; trial < 100; ++trial) {
      const Vector3 at(coordinate(random), coordinate(random), coordinate(random));
      const SurfaceDistance here = distance(surface, at);
      EXPECT_NEAR(here.normal.norm(), 1.0, 1e-14);
      for (int k = 0; k < 3; ++k) {
        const Vector3 step = kStep * Vector3::Unit(k);
        const double slope =
            (distance(surface, at + step).gap - distance(surface, at - step).gap) / (2.0 * kStep);
        EXPECT_NEAR(slope, here.normal[k], 1e-6);
      }
      // Straight along the normal lies the nearest point of the surface.
      EXPECT_NEAR(distance(surface, at - here.gap * here.normal).gap, 0.0, 1e-15 + 1e-12);
    }
  }
}

TEST(Surface, EveryRegionOfACapsule) {
  const Capsule capsule{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.25};
  EXPECT_DOUBLE_EQ(distance(capsule, {0.5, 1.0, 0.0}).gap, 0.75);     // beside the segment
  EXPECT_DOUBLE_EQ(distance(capsule, {-1.0, 0.0, 0.0}).gap, 0.75);    // before its beginning
  EXPECT_DOUBLE_EQ(distance(capsule, {1.0, 0.0, -2.0}).gap, 1.75);    // at its end
  EXPECT_DOUBLE_EQ(distance(capsule, {3.0, 0.0, 0.0}).gap, 1.75);     // beyond it
  const SurfaceDistance inside = distance(capsule, {0.5, 0.0, 0.0});  // on the axis
  EXPECT_DOUBLE_EQ(inside.gap, -0.25);
  EXPECT_NEAR(inside.normal[0], 0.0, 1e-15);
  const Capsule ball{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}, 0.25};  // without length
  EXPECT_DOUBLE_EQ(distance(ball, {0.0, 1.0, 0.0}).gap, 0.75);
  EXPECT_DOUBLE_EQ(distance(Sphere{{0.0, 0.0, 0.0}, 0.25}, {0.0, 0.0, 0.0}).gap, -0.25);
}

TEST(Surface, TangentFrameIsOrthonormal) {
  std::mt19937 random(5);
  std::normal_distribution<double> number;
  for (int trial = 0; trial < 200; ++trial) {
    Vector3 normal = Vector3(number(random), number(random), number(random)).normalized();
    if (trial == 0) normal = Vector3::UnitZ();
    if (trial == 1) normal = -Vector3::UnitZ();
    const Matrix3 frame = tangent_frame(normal);
    EXPECT_LT((frame.transpose() * frame - Matrix3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(frame.determinant(), 1.0, 1e-14);
    EXPECT_EQ(frame.col(0), normal);
  }
}

TEST(Surface, RefusesWhatHasNoSize) {
  EXPECT_THROW(checked(Plane{{}, Vector3::Zero()}), Error);
  EXPECT_THROW(checked(Sphere{{}, 0.0}), Error);
  EXPECT_THROW(checked(Capsule{{}, Vector3::UnitX(), -1.0}), Error);
  EXPECT_DOUBLE_EQ(std::get<Plane>(checked(Plane{{}, 3.0 * Vector3::UnitX()})).normal[0], 1.0);
}

/// A point of a bent beam near a ball that moves and turns in the step.
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
    auto& body = simulation_.fem_body(0);
    std::mt19937 random(11);
    std::normal_distribution<double> noise;
    std::vector<double> state(body.state_size());
    body.save_state(state);
    for (std::size_t i = 0; i < state.size() / 2; ++i) state[i] += t * noise(random);
    body.load_state(state);
  }

  std::shared_ptr<const sim::Model> model_;
  sim::Simulation simulation_;
};

TEST_F(ContactRows, AreTheDerivativeOfGapAndSlip) {
  const auto& effector = dynamic_cast<const PointEffector&>(model_->effector(0));
  for (const Surface& surface : surfaces()) {
    Contact contact("contact", {effector.point()}, surface, 0.5);
    mechanics::RowPattern pattern;
    std::vector<mechanics::RowCurvature> curvatures;
    contact.declare(pattern, curvatures);
    mechanics::RowValues values;
    values.resize(pattern);
    const Placement& placement = simulation_.world().placement();
    contact.begin_step(placement, pose(1.0), pose(1.5), values);
    contact.linearise(placement, values);
    const VectorX before = values.delta;
    const Vector3 at = placement.position(effector.point());
    const double gap = contact.distance_now(placement, pose(1.5), 0).gap;
    const double t = 1e-6;
    shift(t);
    contact.linearise(placement, values);
    const Vector3 moved = placement.position(effector.point()) - at;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR((values.delta[k] - before[k]) / t,
                  values.direction[static_cast<std::size_t>(k)].dot(moved) / t, 1e-8);
    }
    // The gap's row agrees with the exact gap to second order in the distance from where the
    // surface carries the point.
    const double carried = (at - pose(1.5) * pose(1.0).inverse() * at).norm();
    EXPECT_NEAR(before[0], gap, carried * carried / 0.005);
    shift(-t);
  }
}

TEST_F(ContactRows, PointThatTheSurfaceCarriesDoesNotSlip) {
  const auto& effector = dynamic_cast<const PointEffector&>(model_->effector(0));
  Contact contact("contact", {effector.point()}, Sphere{{0.1, 0.0, 0.03}, 0.03}, 0.5);
  mechanics::RowPattern pattern;
  std::vector<mechanics::RowCurvature> curvatures;
  contact.declare(pattern, curvatures);
  mechanics::RowValues values;
  values.resize(pattern);
  auto& body = simulation_.fem_body(0);
  const Placement& placement = simulation_.world().placement();
  contact.begin_step(placement, pose(0.0), pose(2.0), values);
  std::vector<double> state(body.state_size());
  body.save_state(state);
  const Eigen::Isometry3d carry = pose(2.0) * pose(0.0).inverse();
  for (std::size_t i = 0; i + 2 < state.size() / 2; i += 3) {
    const Vector3 moved = carry * Vector3(state[i], state[i + 1], state[i + 2]);
    for (std::size_t c = 0; c < 3; ++c) state[i + c] = moved[static_cast<int>(c)];
  }
  const double gap = contact.distance_now(placement, pose(0.0), 0).gap;
  body.load_state(state);
  contact.linearise(placement, values);
  EXPECT_NEAR(values.delta[0], gap, 1e-14);
  EXPECT_NEAR(values.delta[1], 0.0, 1e-14);
  EXPECT_NEAR(values.delta[2], 0.0, 1e-14);
}

TEST(Contact, RefusesBadFrictionAndNoPoints) {
  EXPECT_THROW(Contact("c", {{0, 0}}, Plane{}, -0.1), Error);
  EXPECT_THROW(Contact("c", {}, Plane{}, 0.1), Error);
}

}  // namespace
}  // namespace sinew::constraint
