#include "sinew/constraint/contact.hpp"

#include <random>

#include <gtest/gtest.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/constraint/placement.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/sim/simulation.hpp"

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

TEST(Surface, PrincipalFrameIsThatOfTheSecondDerivative) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-0.1, 0.1);
  constexpr double kStep = 1e-7;
  for (const Surface& surface : surfaces()) {
    for (int trial = 0; trial < 100; ++trial) {
      const Vector3 at(coordinate(random), coordinate(random), coordinate(random));
      const PrincipalFrame principal = principal_frame(surface, at);
      const Matrix3& frame = principal.frame;
      EXPECT_LT((frame.transpose() * frame - Matrix3::Identity()).norm(), 1e-12);
      EXPECT_LT((frame.col(0) - distance(surface, at).normal).norm(), 1e-12);
      const Matrix3 second = frame * principal.curvature.asDiagonal() * frame.transpose();
      for (int k = 0; k < 3; ++k) {
        const Vector3 step = kStep * Vector3::Unit(k);
        const Vector3 turn =
            (distance(surface, at + step).normal - distance(surface, at - step).normal) /
            (2.0 * kStep);
        EXPECT_LT((turn - second.col(k)).norm(), 1e-5 * (1.0 + turn.norm()));
      }
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

// Against many points of the way: the first that is inside, else the nearest.
TEST(Surface, ApproachIsTheFirstMeetingOrTheNearestPoint) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-0.06, 0.06);
  constexpr int kParts = 4000;
  int met = 0, missed = 0, between = 0;
  for (const Surface& surface : surfaces()) {
    for (int trial = 0; trial < 400; ++trial) {
      const Vector3 from(coordinate(random), coordinate(random), coordinate(random));
      const Vector3 to(coordinate(random), coordinate(random), coordinate(random));
      if (distance(surface, from).gap <= 0.0) continue;
      double least = distance(surface, from).gap, first = -1.0, at = 0.0;
      for (int k = 1; k <= kParts && first < 0.0; ++k) {
        const double share = static_cast<double>(k) / kParts;
        const double gap = distance(surface, from + share * (to - from)).gap;
        if (gap < 0.0) first = share;
        if (gap < least) at = share;
        least = std::min(least, gap);
      }
      const SurfaceApproach found = approach(surface, from, to);
      const double share = (found.at - from).norm() / (to - from).norm();
      const Vector3 normal = found.distance.normal;
      if (std::abs(least) < 1e-6) continue;  // grazes
      EXPECT_EQ(found.meets, first >= 0.0);
      if (found.meets) {
        ++met;
        EXPECT_NEAR(share, first, 1.0 / kParts + 1e-9);
        EXPECT_GE(found.distance.gap, -1e-14);
        EXPECT_LT(normal.dot(to - found.at), 0.0);
      } else {
        ++missed;
        between += share > 1e-6 && share < 1.0 - 1e-6 ? 1 : 0;
        EXPECT_LE(found.distance.gap, least + 1e-12);
        EXPECT_NEAR(found.distance.gap, least, 1e-6);
        if (least > 1e-3) {
          EXPECT_NEAR(share, at, 0.01);
        }
        EXPECT_GT(found.distance.gap + normal.dot(to - found.at), 0.0);  // no plane in its way
      }
      EXPECT_GE(found.distance.gap + normal.dot(from - found.at), -1e-14);
      // No point of the solid lies beyond the plane.
      const Vector3 foot = found.at - (found.distance.gap - 1e-9) * normal;
      EXPECT_GE(distance(surface, foot + 0.02 * normal.unitOrthogonal()).gap, 0.0);
    }
  }
  EXPECT_GT(met, 40);
  EXPECT_GT(missed, 300);
  EXPECT_GT(between, 50);
}

TEST(Surface, ApproachOfPointsThatRestTouchOrLeave) {
  const Sphere ball{Vector3::Zero(), 1.0};
  const Vector3 top(0.0, 0.0, 1.0);
  const SurfaceApproach rests = approach(ball, top, top);
  EXPECT_EQ(rests.at, top);
  EXPECT_FALSE(rests.meets);
  EXPECT_FALSE(approach(ball, top, {0.0, 0.0, 2.0}).meets);  // leaves
  EXPECT_FALSE(approach(ball, top, {1.0, 0.0, 1.0}).meets);  // along the tangent
  EXPECT_TRUE(approach(ball, top, {1.0, 0.0, 0.99}).meets);  // into it at once
  EXPECT_EQ(approach(ball, top, {0.0, 0.0, -3.0}).at, top);  // not out at the other side
  EXPECT_FALSE(approach(ball, {0.0, 0.0, 0.5}, {0.0, 0.0, 2.0}).meets);  // from inside, out
  const SurfaceApproach inside = approach(ball, {0.0, 0.0, 0.5}, {0.0, 0.0, 0.1});
  EXPECT_TRUE(inside.meets);
  EXPECT_DOUBLE_EQ(inside.distance.gap, -0.5);
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
    auto& body = simulation_.body(0);
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
    const Placement& placement = simulation_.placement();
    contact.begin_step(placement, pose(1.0), pose(1.5), 0.0, values);
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

// The frame of a step is that of the way at the point's velocity; rows and positions agree in it.
TEST_F(ContactRows, FrameIsThatOfTheWay) {
  const auto& effector = dynamic_cast<const PointEffector&>(model_->effector(0));
  const Placement& placement = simulation_.placement();
  auto& body = simulation_.body(0);
  std::vector<double> state(body.state_size());
  body.save_state(state);
  for (std::size_t i = state.size() / 2; i < state.size(); i += 3) state[i] = 1.0;  // along x
  body.load_state(state);
  const Vector3 at = placement.position(effector.point());
  const Sphere ball{at + Vector3(0.05, 0.0, -0.0051), 0.005};
  Contact contact("contact", {effector.point()}, ball, 0.5);
  mechanics::RowPattern pattern;
  std::vector<mechanics::RowCurvature> curvatures;
  contact.declare(pattern, curvatures);
  mechanics::RowValues values;
  values.resize(pattern);
  const Eigen::Isometry3d rest = Eigen::Isometry3d::Identity();
  contact.begin_step(placement, rest, rest, 0.1, values);
  EXPECT_LT((values.direction[0] - Vector3::UnitZ()).norm(), 1e-9);  // where it passes
  EXPECT_NEAR(values.reference[0], 1e-4, 1e-12);
  for (const Vector3& point : {at, Vector3(0.3, -0.2, 0.1)}) {
    const Vector3 rows = contact.row_values(0, point, values);
    EXPECT_LT((contact.position(0, rows, values) - point).norm(), 1e-15);
  }
  contact.begin_step(placement, rest, rest, 0.0, values);  // stays
  EXPECT_LT(values.direction[0][0], -0.9);
}

TEST_F(ContactRows, PointThatTheSurfaceCarriesDoesNotSlip) {
  const auto& effector = dynamic_cast<const PointEffector&>(model_->effector(0));
  Contact contact("contact", {effector.point()}, Sphere{{0.1, 0.0, 0.03}, 0.03}, 0.5);
  mechanics::RowPattern pattern;
  std::vector<mechanics::RowCurvature> curvatures;
  contact.declare(pattern, curvatures);
  mechanics::RowValues values;
  values.resize(pattern);
  auto& body = simulation_.body(0);
  const Placement& placement = simulation_.placement();
  contact.begin_step(placement, pose(0.0), pose(2.0), 0.0, values);
  std::vector<double> state(body.state_size());
  body.save_state(state);
  const Eigen::Isometry3d carry = pose(2.0) * pose(0.0).inverse();
  for (std::size_t i = 0; i + 2 < state.size() / 2; i += 3) {
    const Vector3 moved = carry * Vector3(state[i], state[i + 1], state[i + 2]);
    for (std::size_t c = 0; c < 3; ++c) state[i + c] = moved[static_cast<int>(c)];
  }
  body.load_state(state);
  contact.linearise(placement, values);
  EXPECT_NEAR(values.delta[0], values.reference[0], 1e-14);
  EXPECT_NEAR(values.delta[1], 0.0, 1e-14);
  EXPECT_NEAR(values.delta[2], 0.0, 1e-14);
}

TEST(Contact, RefusesBadFrictionAndNoPoints) {
  EXPECT_THROW(Contact("c", {{0, 0}}, Plane{}, -0.1), Error);
  EXPECT_THROW(Contact("c", {}, Plane{}, 0.1), Error);
}

}  // namespace
}  // namespace sinew::constraint
