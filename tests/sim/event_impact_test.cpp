// Impacts of rigid bodies against closed forms of Newton's law with friction in Moreau's form.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"

#include "event_robots.hpp"

namespace sinew::testing {
namespace {

const Vector3 kNone = Vector3::Zero();

Vector3 velocity(const sim::Simulation& simulation, int body) {
  return pose(simulation, body).linear_velocity();
}

double kinetic(sim::Simulation& simulation) { return simulation.energies().kinetic; }

TEST(EventImpact, BallsHeadOn) {
  for (const double e : {0.0, 0.6, 1.0}) {
    builder::ModelBuilder builder(events(20e-3, e));
    const int first =
        add_ball(builder, "first", Vector3(-0.2, 0.0, 0.0), Vector3(3.0, 0, 0), kNone);
    const int second = add_ball(builder, "second", Vector3(0.1, 0, 0), Vector3(-1.0, 0, 0), kNone);
    add_pair(builder, first, second);
    sim::Simulation simulation(builder.build());
    int impacts = 0;
    for (int k = 0; k < 10; ++k) impacts += simulation.step().impacts;
    const double u = velocity(simulation, 0)[0], v = velocity(simulation, 1)[0];
    EXPECT_EQ(impacts, 1);
    EXPECT_NEAR(u + v, 2.0, 1e-12);
    EXPECT_NEAR(v - u, 4.0 * e, 1e-9);
    // They meet after 0.2 m at 4 m/s.
    EXPECT_NEAR(pose(simulation, 0).origin()[0], -0.2 + 3.0 * 0.05 + u * 0.15, 1e-9);
  }
}

// Along the line of centres the balls obey Newton's law; no impulse acts across it. The tangent
// planes follow the balls until they touch.
TEST(EventImpact, BallsThatMeetAskew) {
  const double e = 0.7, offset = 0.06;
  builder::ModelBuilder builder(events(20e-3, e));
  const int first = add_ball(builder, "first", Vector3(-0.5, 0, 0), Vector3(5.0, 0, 0), kNone);
  const int second = add_ball(builder, "second", Vector3(0.0, offset, 0.0), kNone, kNone);
  add_pair(builder, first, second);
  sim::Simulation simulation(builder.build());
  for (int k = 0; k < 20; ++k) simulation.step();
  const Vector3 normal(std::sqrt(0.01 - offset * offset) / 0.1, offset / 0.1, 0.0);
  const Vector3 given = 0.5 * (1.0 + e) * 5.0 * normal[0] * normal;
  EXPECT_LT((velocity(simulation, 1) - given).norm(), 1e-7);
  EXPECT_LT((velocity(simulation, 0) - (Vector3(5.0, 0, 0) - given)).norm(), 1e-7);
}

// Balls that narrowly miss each other do not touch, however long the step.
TEST(EventImpact, AMissIsNone) {
  builder::ModelBuilder builder(events(50e-3, 1.0));
  const int first = add_ball(builder, "first", Vector3(-0.5, 0, 0), Vector3(20.0, 0, 0), kNone);
  const int second = add_ball(builder, "second", Vector3(0.0, 0.1 + 1e-6, 0.0), kNone, kNone);
  add_pair(builder, first, second);
  sim::Simulation simulation(builder.build());
  int impacts = 0;
  for (int k = 0; k < 4; ++k) impacts += simulation.step().impacts;
  EXPECT_EQ(impacts, 0);
  EXPECT_LT((velocity(simulation, 0) - Vector3(20.0, 0, 0)).norm(), 1e-11);
}

// A ball between others does not pass through them in one step.
TEST(EventImpact, NothingTunnels) {
  builder::ModelBuilder builder(events(50e-3, 1.0));
  const int first = add_ball(builder, "first", Vector3(-0.5, 0, 0), Vector3(40.0, 0, 0), kNone);
  const int second = add_ball(builder, "second", kNone, kNone, kNone);
  add_pair(builder, first, second);
  sim::Simulation simulation(builder.build());
  EXPECT_EQ(simulation.step().impacts, 1);
  EXPECT_NEAR(velocity(simulation, 1)[0], 40.0, 1e-9);
  EXPECT_NEAR(velocity(simulation, 0)[0], 0.0, 1e-9);
}

// Newton's law treats simultaneous contacts as one impact: of three equal balls that touch, the
// first rebounds with a third of its speed, and the others move on together with two thirds. Energy
// and momentum are conserved. If the balls are apart, the impacts follow each other.
TEST(EventImpact, Cradle) {
  for (const double gap : {0.0, 1e-4}) {
    builder::ModelBuilder builder(events(20e-3, 1.0));
    const int first = add_ball(builder, "first", Vector3(-0.2, 0, 0), Vector3(3.0, 0, 0), kNone);
    const int second = add_ball(builder, "second", kNone, kNone, kNone);
    const int third = add_ball(builder, "third", Vector3(0.1 + gap, 0, 0), kNone, kNone);
    add_pair(builder, first, second);
    add_pair(builder, second, third);
    sim::Simulation simulation(builder.build());
    for (int k = 0; k < 5; ++k) simulation.step();
    const double speeds[2][3] = {{-1.0, 2.0, 2.0}, {0.0, 0.0, 3.0}};
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(velocity(simulation, k)[0], speeds[gap > 0.0 ? 1 : 0][k], 1e-8) << k;
    }
  }
}

// The effective mass of a ball's contact point is m along the normal and 2/7 m across it. If it
// sticks, its slip velocity becomes -e times itself; if it slides, the impulse is at the friction
// limit.
TEST(EventImpact, SpinAndFriction) {
  const double e = 0.6, radius = 0.05, mass = 2.0;
  for (const double friction : {0.1, 0.8}) {
    builder::ModelBuilder builder(events(5e-3, e));
    const Vector3 before(1.5, 0.5, -3.0), spin(20.0, 30.0, 7.0);
    const int ball = add_ball(builder, "ball", Vector3(0, 0, 0.1), before, kNone, radius, spin);
    add_floor(builder, ball, Vector3::UnitZ(), friction);
    sim::Simulation simulation(builder.build());
    const double start = kinetic(simulation);
    for (int k = 0; k < 8; ++k) simulation.step();
    const Vector3 arm(0.0, 0.0, -radius);
    Vector3 slip = before + spin.cross(arm);
    slip[2] = 0.0;
    const double normal = mass * (1.0 + e) * 3.0;
    Vector3 impulse = -2.0 / 7.0 * mass * (1.0 + e) * slip;
    const bool sticks = impulse.norm() <= friction * normal;
    EXPECT_EQ(sticks, friction > 0.5);
    if (!sticks) impulse *= friction * normal / impulse.norm();
    impulse[2] = normal;
    const Vector3 after = before + impulse / mass;
    const Vector3 turned = spin + arm.cross(impulse) / (0.4 * mass * radius * radius);
    EXPECT_LT((velocity(simulation, 0) - after).norm(), 1e-9);
    EXPECT_LT((pose(simulation, 0).angular_velocity() - turned).norm(), 1e-8);
    EXPECT_LT(kinetic(simulation), start);
    EXPECT_NEAR(simulation.ledger().dissipated, start - kinetic(simulation), 1e-9 * start);
  }
}

std::unique_ptr<sim::Simulation> box(double lean, double restitution, double step) {
  builder::ModelBuilder builder(events(step, restitution));
  rigid::RigidSettings box;
  box.name = "box";
  box.shape = rigid::Box{{0.1, 0.1, 0.1}};
  box.mass = 2.0;
  box.rotation = Eigen::AngleAxisd(lean, Vector3::UnitY()).toRotationMatrix();
  box.position = Vector3(0.0, 0.0, 0.3);
  box.gravity = Vector3(0.0, 0.0, -kGravity);
  add_floor(builder, builder.add_body<rigid::RigidBodyModel>(box));
  return std::make_unique<sim::Simulation>(builder.build());
}

// All four corners hit at the same time.
TEST(EventImpact, ABoxThatLandsFlatBouncesLikeABall) {
  const double e = 0.5, first = std::sqrt(2.0 * 0.25 / kGravity);
  const auto simulation = box(0.0, e, 10e-3);
  int impacts = 0;
  while (simulation->time() < 0.3) impacts += simulation->step().impacts;
  const double since = simulation->time() - first, speed = e * kGravity * first;
  EXPECT_EQ(impacts, 1);
  EXPECT_NEAR(pose(*simulation, 0).origin()[2],
              0.05 + speed * since - 0.5 * kGravity * since * since, 1e-8);
  EXPECT_LT(pose(*simulation, 0).angular_velocity().norm(), 1e-8);
  while (simulation->time() < 1.1 * first * (1.0 + e) / (1.0 - e)) simulation->step();
  EXPECT_NEAR(pose(*simulation, 0).origin()[2], 0.05, 1e-9);
  EXPECT_LT(velocity(*simulation, 0).norm(), 1e-8);
}

// An edge at the horizontal distance x from the centre hits with p = (1 + e) m v/(1 + m x^2/I).
TEST(EventImpact, ABoxThatLandsOnAnEdgeTurns) {
  const double e = 0.4, lean = 0.3, mass = 2.0, inertia = mass * 0.01 / 6.0;
  const auto simulation = box(lean, e, 10e-3);
  const double low = 0.05 * (std::cos(lean) + std::sin(lean));
  const double first = std::sqrt(2.0 * (0.3 - low) / kGravity), speed = kGravity * first;
  const double beside = 0.05 * (std::cos(lean) - std::sin(lean));  // |x| of the lowest edge
  int impacts = 0;
  while (impacts == 0) impacts += simulation->step().impacts;
  const double since = simulation->time() - first;
  const double impulse = (1.0 + e) * mass * speed / (1.0 + mass * beside * beside / inertia);
  EXPECT_NEAR(velocity(*simulation, 0)[2], impulse / mass - speed - kGravity * since, 1e-8);
  EXPECT_NEAR(pose(*simulation, 0).angular_velocity().norm(), impulse * beside / inertia, 1e-7);
}

// It tumbles, and comes to rest on a face.
TEST(EventImpact, ABoxComesToRest) {
  for (const double e : {0.0, 0.5}) {
    expect_rest(*box(0.3, e, 5e-3), 2.0 * kGravity * 0.3, 0.05, 1e-7, 1e-6);
  }
}

// A pendulum that hits a wall at its lowest point. Its reduced length is L = l + 2 r^2/(5 l).
class Pendulum {
 public:
  Pendulum(double step, double e) {
    builder::ModelBuilder builder(events(step, e));
    const Vector3 at = kLength * Vector3(-std::sin(kStart), 0.0, -std::cos(kStart));
    const int ball = add_ball(builder, "ball", at);
    builder::JointSettings hinge;
    hinge.name = "hinge";
    hinge.first = model::kWorld;
    hinge.second = ball;
    hinge.axis = Vector3::UnitY();
    builder.add_joint(hinge);
    builder::ContactSettings wall;
    wall.name = "wall";
    wall.body = ball;
    wall.surface = collision::Plane{Vector3(0.05, 0.0, 0.0), -Vector3::UnitX()};
    builder.add_contact(wall);
    simulation = std::make_unique<sim::Simulation>(builder.build());
  }
  double angle() const {
    const Vector3 at = pose(*simulation, 0).origin();
    return std::atan2(at[0], -at[2]);
  }
  double rate() const { return -pose(*simulation, 0).angular_velocity()[1]; }
  // Period of a swing of the given amplitude, s.
  static double period(double angle) {
    return 4.0 * std::sqrt(kReduced / kGravity) * std::comp_ellint_1(std::sin(0.5 * angle));
  }

  static constexpr double kStart = 0.8, kLength = 0.4, kReduced = kLength + 0.4 * 0.0025 / kLength;
  std::unique_ptr<sim::Simulation> simulation;
};

// Each impact leaves e of the angular velocity w = 2 sqrt(g/L) sin(angle/2); the next one follows
// half a period later.
TEST(EventImpact, APendulumStrikesAWallInTime) {
  const double e = 0.8;
  double errors[2] = {};
  for (const int fine : {0, 1}) {
    Pendulum pendulum(fine == 0 ? 4e-3 : 2e-3, e);
    double sine = std::sin(0.5 * Pendulum::kStart),
           moment = 0.25 * Pendulum::period(Pendulum::kStart);
    int struck = 0;
    while (struck < 4) {
      if (pendulum.simulation->step().impacts == 0) continue;
      ++struck;
      // The angle is small and has grown at a constant rate since the impact.
      const double found = pendulum.simulation->time() - pendulum.angle() / pendulum.rate();
      errors[fine] = std::max(errors[fine], std::abs(found - moment) / moment);
      sine *= e;
      moment += 0.5 * Pendulum::period(2.0 * std::asin(sine));
    }
  }
  EXPECT_LT(errors[1], 2e-5);
  EXPECT_NEAR(errors[0] / errors[1], 4.0, 1.0);  // second order
}

// A rubber block falls next to a ball. While the block is in flight, the ball moves as if alone;
// while the block touches the floor, steps are by backward Euler, which lose g h t/2 of height.
TEST(EventDriven, ADeformableBodyFallsBesideABall) {
  BlockOptions options{.step = events(2e-3, 0.5), .height = 0.01};
  builder::ModelBuilder builder = block_on_plane(options);
  const int ball = add_ball(builder, "ball", Vector3(0.3, 0.0, 0.1));
  add_floor(builder, ball);
  sim::Simulation simulation(builder.build());
  builder::ModelBuilder other(options.step);
  add_floor(other, add_ball(other, "ball", Vector3(0.3, 0.0, 0.1)));
  sim::Simulation alone(other.build());
  for (int k = 0; k < 200; ++k) {
    const run::StepReport& report = simulation.step();
    EXPECT_EQ(report.status, run::StepStatus::solved);
    alone.step();
    const double error = pose(simulation, ball).origin()[2] - pose(alone, 0).origin()[2];
    const double time = simulation.time();
    const bool flies = time < std::sqrt(2.0 * options.height / kGravity);
    EXPECT_LT(std::abs(error), flies ? 1e-12 : 0.5 * kGravity * options.step.time_step * time);
  }
  EXPECT_NEAR(pose(simulation, ball).origin()[2], 0.05, 1e-9);
  EXPECT_NEAR(simulation.contacts().resultant(0).normal_force, kBlockWeight, 1e-3 * kBlockWeight);
  EXPECT_NEAR(simulation.contacts().resultant(1).normal_force, 2.0 * kGravity, 1e-6);
}

// A ball that falls on soft ground rebounds by the ground's elasticity.
TEST(EventDriven, ABallReboundsFromADeformableBody) {
  BlockOptions options{.step = events(0.5e-3, 0.9), .friction = 0.5, .modulus = 1e7};
  options.damping = {};
  builder::ModelBuilder builder = block_on_plane(options);
  const int ball = add_ball(builder, "ball", Vector3(0.0, 0.0, 0.071), Vector3(0.0, 0.0, -0.3),
                            Vector3(0.0, 0.0, -kGravity));
  builder::ContactSettings contact;
  contact.name = "ground";
  contact.body = 0;
  contact.touched = ball;
  contact.friction = 0.5;
  contact.points = Points(1, 3);
  contact.points << 0.0, 0.0, 0.02;
  builder.add_contact(contact);
  sim::Simulation simulation(builder.build());
  const double start = simulation.energies().total();
  double fastest = 0.0;
  for (int k = 0; k < 60; ++k) {
    const run::StepReport& report = simulation.step();
    EXPECT_EQ(report.status, run::StepStatus::solved);
    EXPECT_EQ(report.impacts, 0);
    fastest = std::max(fastest, pose(simulation, ball).linear_velocity()[2]);
    EXPECT_LT(simulation.energies().total(), start + 1e-6);
  }
  EXPECT_GT(fastest, 0.1);
}

// Unsupported combinations are rejected with a remedy.
class Refused : public ::testing::Test {
 protected:
  template <class Build>
  static ErrorKind kind_of(Build&& build) {
    try {
      build();
    } catch (const Error& error) {
      EXPECT_FALSE(error.remedy().empty());
      return error.kind();
    }
    return ErrorKind::internal;
  }
};

TEST_F(Refused, SettingsThatDivideStepsOtherwise) {
  model::StepSettings adaptive = events(1e-3, 0.5);
  adaptive.adaptive = model::AdaptiveStep{.tolerance = 1e-4, .smallest = 1e-5};
  EXPECT_EQ(kind_of([&] { builder::ModelBuilder{adaptive}; }), ErrorKind::not_in_this_version);
  model::StepSettings linear = events(1e-3, 0.5);
  linear.method = model::Method::one_linearisation;
  EXPECT_EQ(kind_of([&] { builder::ModelBuilder{linear}; }), ErrorKind::not_in_this_version);
  EXPECT_EQ(kind_of([] { builder::ModelBuilder{events(1e-3, 1.5)}; }), ErrorKind::out_of_range);
}

TEST_F(Refused, RestitutionWhereNothingStrikes) {
  const auto add = [](const model::StepSettings& step, bool rigid, double restitution, bool jumps) {
    builder::ModelBuilder builder = block_on_plane({.step = step, .floor = false});
    builder::ContactSettings contact;
    contact.name = "floor";
    contact.surface = collision::Plane{};
    contact.body = rigid ? add_ball(builder, "ball", Vector3(0.3, 0.0, 0.1)) : 0;
    if (!rigid) contact.points = Points::Zero(1, 3);
    contact.restitution = restitution;
    if (jumps) {
      contact.motion.emplace();
      contact.motion->translation[2] = model::Signal::steps({{0.0, 0.0}, {0.1, 0.01}});
    }
    builder.add_contact(contact);
  };
  const model::StepSettings step = events(1e-3, 0.5);
  EXPECT_EQ(kind_of([&] { add(step, false, 0.5, false); }), ErrorKind::conflicting_keys);
  EXPECT_EQ(kind_of([&] { add(step, true, 1.5, false); }), ErrorKind::out_of_range);
  EXPECT_EQ(kind_of([&] { add(step, true, 0.5, true); }), ErrorKind::conflicting_keys);
  model::StepSettings euler = step;
  euler.integrator = mechanics::Integrator::backward_euler;
  EXPECT_EQ(kind_of([&] { add(euler, true, 0.5, false); }), ErrorKind::conflicting_keys);
  add(step, true, 0.5, false);
  add(step, false, 0.0, false);
}

}  // namespace
}  // namespace sinew::testing
