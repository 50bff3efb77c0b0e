// Impacts of rigid bodies with triangle surfaces: against closed forms, and against the same bodies
// as exact shapes.
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sinew/contact/contact_state.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/step_report.hpp"

#include "event_robots.hpp"

namespace sinew::testing {
namespace {

constexpr double kEdge = 0.1;    // m, of the cube
constexpr double kAbove = 0.25;  // m, of its lowest point above the floor

enum class Kind { shape, surface, hull };

rigid::RigidSettings cube(Kind kind) {
  rigid::RigidSettings body;
  body.name = "cube";
  body.shape = rigid::Box{Vector3::Constant(kEdge)};
  if (kind != Kind::shape) body.shape = triangles(body.shape, kind == Kind::hull);
  body.mass = 2.0;
  body.gravity = Vector3(0.0, 0.0, -kGravity);
  return body;
}

// A cube falls onto a fixed slab, which is a mesh unless the cube is a shape.
std::unique_ptr<sim::Simulation> dropped(Kind kind, const Matrix3& rotation, double h, double e,
                                         double friction = 0.0) {
  builder::ModelBuilder builder(events(h, e));
  rigid::RigidSettings body = cube(kind);
  body.rotation = rotation;
  const double low = 0.5 * kEdge * rotation.row(2).cwiseAbs().sum();
  body.position = Vector3(0.013, -0.021, kAbove + low);
  const int falling = builder.add_body<rigid::RigidBodyModel>(body);
  add_pair(builder, falling, add_slab(builder, "floor", kind != Kind::shape), friction);
  return std::make_unique<sim::Simulation>(builder.build());
}

Matrix3 on_its_corner() {
  return Eigen::Quaterniond::FromTwoVectors(Vector3::Ones(), Vector3::UnitZ()).toRotationMatrix();
}

double low(const sim::Simulation& simulation, const Matrix3& rotation) {
  return pose(simulation, 0).origin()[2] - 0.5 * kEdge * rotation.row(2).cwiseAbs().sum();
}

struct Fall {
  Kind kind;
  bool on_corner;
};

class FallingCube : public ::testing::TestWithParam<Fall> {
 protected:
  Matrix3 rotation() const {
    return GetParam().on_corner ? on_its_corner() : Matrix3(Matrix3::Identity());
  }
};

// Flat or on a corner, the cube hits below its centre and bounces like a ball: each impact leaves e
// of its speed, and it is at rest at sqrt(2 h/g) (1 + e)/(1 - e).
TEST_P(FallingCube, BouncesLikeABall) {
  const double e = 0.5, h = 10e-3;
  const auto simulation = dropped(GetParam().kind, rotation(), h, e);
  const double fall = kAbove - kApart, first = std::sqrt(2.0 * fall / kGravity);
  double at = fall, rate = 0.0, begin = 0.0;
  const double end = first * (1.0 + e) / (1.0 - e);
  while (simulation->time() < 0.95 * end) {
    simulation->step();
    for (;;) {
      const double left = (rate + std::sqrt(rate * rate + 2.0 * kGravity * at)) / kGravity;
      if (begin + left > simulation->time()) break;
      rate = e * (kGravity * left - rate);
      begin += left;
      at = 0.0;
    }
    const double t = simulation->time() - begin;
    EXPECT_NEAR(low(*simulation, rotation()) - kApart, at + rate * t - 0.5 * kGravity * t * t, 1e-8)
        << "at " << simulation->time();
    EXPECT_NEAR(pose(*simulation, 0).linear_velocity()[2], rate - kGravity * t, 1e-6);
  }
}

TEST_P(FallingCube, ComesToRestInTime) {
  const double e = 0.5;
  const double end = std::sqrt(2.0 * kAbove / kGravity) * (1.0 + e) / (1.0 - e);
  const int steps = static_cast<int>(std::ceil(end / 20e-3));
  for (const double part : {0.999, 1.001}) {
    const auto simulation = dropped(GetParam().kind, rotation(), part * end / steps, e);
    for (int k = 0; k < steps; ++k) simulation->step();
    const double rate = pose(*simulation, 0).linear_velocity()[2];
    const double above = std::max(low(*simulation, rotation()) - 2e-7, 0.0);
    if (part < 1.0) {
      EXPECT_GT(std::hypot(rate, std::sqrt(2.0 * kGravity * above)), 1e-4);
    } else {
      EXPECT_LT(std::abs(rate), 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Falls, FallingCube,
                         ::testing::Values(Fall{Kind::surface, false}, Fall{Kind::surface, true},
                                           Fall{Kind::hull, false}));

Matrix3 askew() {
  return (Eigen::AngleAxisd(0.5, Vector3::UnitX()) * Eigen::AngleAxisd(0.3, Vector3::UnitY()))
      .toRotationMatrix();
}

// Tilted, with and without friction, the mesh moves like the exact shape from impact to impact.
TEST(EventMesh, ACubeTumblesAsTheShapeDoes) {
  for (const double friction : {0.0, 0.4}) {
    const auto mesh = dropped(Kind::surface, askew(), 5e-3, 0.5, friction);
    const auto shape = dropped(Kind::shape, askew(), 5e-3, 0.5, friction);
    int mesh_impacts = 0, shape_impacts = 0;
    while (shape->time() < 0.4) {
      mesh_impacts += mesh->step().impacts;
      shape_impacts += shape->step().impacts;
      EXPECT_LT((pose(*mesh, 0).origin() - pose(*shape, 0).origin()).norm(), 2e-6)
          << "at " << shape->time();
    }
    EXPECT_EQ(mesh_impacts, shape_impacts);
    EXPECT_GE(shape_impacts, 2);
  }
}

TEST(EventMesh, ACubeComesToRest) {
  for (const double e : {0.0, 0.5}) {
    const auto simulation = dropped(Kind::surface, askew(), 5e-3, e, 0.3);
    expect_rest(*simulation, 2.0 * kGravity * 0.3, 0.5 * kEdge, 1e-6, 1e-5);
  }
}

// Two spinning cubes that collide in free flight.
std::unique_ptr<sim::Simulation> meeting(double e, double speed, double spin, double friction,
                                         bool swapped = false, double h = 10e-3) {
  builder::ModelBuilder builder(events(h, e));
  std::vector<rigid::RigidSettings> bodies;
  for (const double side : {-1.0, 1.0}) {
    rigid::RigidSettings body = cube(Kind::surface);
    body.name = side < 0.0 ? "left" : "right";
    body.mass = side < 0.0 ? 2.0 : 3.0;
    body.gravity.setZero();
    body.position = Vector3(0.2 * side, 0.02 * side, 0.01);
    body.velocity = Vector3(-speed * side, 0.0, 0.0);
    body.spin = spin * Vector3(1.0, 2.0 * side, -1.0);
    body.rotation = side < 0.0 ? askew() : Matrix3(Matrix3::Identity());
    bodies.push_back(body);
  }
  if (swapped) std::swap(bodies[0], bodies[1]);
  for (const rigid::RigidSettings& body : bodies) builder.add_body<rigid::RigidBodyModel>(body);
  add_pair(builder, 0, 1, friction);
  return std::make_unique<sim::Simulation>(builder.build());
}

// Total linear and angular momentum; the inertia of a cube is a multiple of the identity.
Vector3 linear_momentum(const sim::Simulation& simulation, int first) {
  return 2.0 * pose(simulation, first).linear_velocity() +
         3.0 * pose(simulation, 1 - first).linear_velocity();
}

Vector3 angular_momentum(const sim::Simulation& simulation) {
  Vector3 sum = Vector3::Zero();
  for (const int body : {0, 1}) {
    const mechanics::HasPose& own = pose(simulation, body);
    const double mass = body == 0 ? 2.0 : 3.0;
    sum += mass * own.origin().cross(own.linear_velocity()) +
           mass * kEdge * kEdge / 6.0 * own.angular_velocity();
  }
  return sum;
}

TEST(EventMesh, CubesThatMeetKeepTheirMomentum) {
  for (const double e : {0.6, 1.0}) {
    const auto simulation = meeting(e, 2.0, 5.0, e == 1.0 ? 0.0 : 0.3);
    const Vector3 linear = linear_momentum(*simulation, 0), turning = angular_momentum(*simulation);
    double energy = simulation->energies().kinetic;
    const double start = energy;
    int impacts = 0;
    for (int k = 0; k < 30; ++k) {
      impacts += simulation->step().impacts;
      const double now = simulation->energies().kinetic;
      EXPECT_LE(now, energy + 1e-9 * start);
      energy = now;
    }
    EXPECT_GE(impacts, 1);
    EXPECT_LT((linear_momentum(*simulation, 0) - linear).norm(), 1e-9);
    EXPECT_LT((angular_momentum(*simulation) - turning).norm(), 1e-7);
    if (e == 1.0) {
      EXPECT_NEAR(energy, start, 1e-8 * start);
    }
  }
}

// Without restitution, the cubes slide on each other, edge on turning edge, and around a corner.
// They land once and stay in contact until one edge has passed the other.
TEST(EventMesh, CubesThatDoNotReboundSlideOff) {
  const auto simulation = meeting(0.0, 2.0, 5.0, 0.3);
  const Vector3 linear = linear_momentum(*simulation, 0);
  double energy = simulation->energies().kinetic;
  const double start = energy;
  int impacts = 0;
  for (int k = 0; k < 13; ++k) {
    const run::StepReport& report = simulation->step();
    impacts += report.impacts;
    EXPECT_LT(report.substeps, 40) << "at " << simulation->time();
    const double now = simulation->energies().kinetic;
    EXPECT_LE(now, energy + 1e-6 * start) << "at " << simulation->time();
    energy = now;
  }
  EXPECT_GE(impacts, 1);
  EXPECT_LE(impacts, 3);
  EXPECT_LT((linear_momentum(*simulation, 0) - linear).norm(), 1e-6);
}

// Cubes that slide on each other without friction keep their energy after they have landed, in long
// and in short steps: there are no further impacts, and the contact forces do no work.
TEST(EventMesh, CubesThatSlideKeepTheirEnergy) {
  std::vector<Vector3> places;
  for (const double h : {10e-3, 5e-3, 2.5e-3}) {
    const auto simulation = meeting(0.0, 2.0, 5.0, 0.0, false, h);
    double landed = 0.0;
    int impacts = 0;
    while (simulation->time() < 0.08 - 0.5 * h) {
      impacts += simulation->step().impacts;
      const double now = simulation->energies().kinetic;
      if (simulation->time() < 0.07 + 0.5 * h) landed = now;
    }
    EXPECT_EQ(impacts, 1) << "steps of " << h;
    EXPECT_NEAR(simulation->contacts().resultant(0).smallest_gap, 0.0, 1e-9);
    EXPECT_NEAR(simulation->energies().kinetic, landed, 1e-5 * landed) << "steps of " << h;
    places.push_back(pose(*simulation, 0).origin());
  }
  EXPECT_LT((places[1] - places[0]).norm(), 1e-5);
  EXPECT_LT((places[2] - places[0]).norm(), 1e-5);
}

// A cube slides along the axis of a slab that turns. The upper side of the slab faces x, and its
// normal passes the xy plane just before the end of the tenth step, so the tangents of the contact
// frames are reversed there. Friction opposes the slip before and after that.
TEST(EventMesh, FrictionOpposesTheSlipOnATurningFace) {
  const double h = 5e-3, rate = 0.5, angle = -9.9 * h * rate;
  const Matrix3 start = Eigen::AngleAxisd(angle, Vector3::UnitY()).toRotationMatrix();
  const Vector3 spin = rate * Vector3::UnitY();
  builder::ModelBuilder builder(events(h, 0.0));
  rigid::RigidSettings body = cube(Kind::surface);
  body.rotation = start;
  body.position = start * Vector3(0.5 * kEdge + 1e-6, 0.0, 0.0);
  body.velocity = Vector3(0.0, 1.0, 0.0) + spin.cross(body.position);
  body.spin = spin;
  body.gravity = Vector3(-kGravity, 0.0, 0.0);
  const int sliding = builder.add_body<rigid::RigidBodyModel>(body);
  rigid::RigidSettings slab;
  slab.name = "slab";
  slab.shape = triangles(rigid::Box{{0.1, 1.0, 1.0}});
  slab.rotation = start;
  slab.position = start * Vector3(-0.05, 0.0, 0.0);
  slab.fixed = true;
  model::BaseMotion motion;
  motion.body = builder.add_body<rigid::RigidBodyModel>(slab);
  motion.axis = Vector3::UnitY();
  motion.angle = model::Signal::ramp({0.0, 10.0 * rate, 0.0, 10.0});
  builder.add_base_motion(motion, {});
  add_pair(builder, sliding, motion.body, 0.3);
  sim::Simulation simulation(builder.build());
  int pressed = 0;
  for (int k = 0; k < 15; ++k) {
    simulation.step();
    const mechanics::HasPose& own = pose(simulation, sliding);
    for (const contact::ContactPoint& point : simulation.contacts().points(0)) {
      if (!(point.normal_force > 1e-3)) continue;
      const Vector3 slip = own.linear_velocity() +
                           own.angular_velocity().cross(point.position - own.centre_of_mass()) -
                           spin.cross(point.position);
      EXPECT_LT(point.friction_force.dot(slip), 0.0) << "at " << simulation.time();
      ++pressed;
    }
  }
  EXPECT_GT(pressed, 0);
}

TEST(EventMesh, TheOrderOfBodiesDoesNotMatter) {
  const auto one = meeting(0.6, 2.0, 5.0, 0.3), other = meeting(0.6, 2.0, 5.0, 0.3, true);
  for (int k = 0; k < 30; ++k) {
    one->step();
    other->step();
  }
  for (const int body : {0, 1}) {
    EXPECT_LT((pose(*one, body).origin() - pose(*other, 1 - body).origin()).norm(), 1e-8);
  }
}

// At 80 m/s a step covers 0.8 m, through the other cube and far beyond.
TEST(EventMesh, FastCubesDoNotPass) {
  for (const double spin : {0.0, 40.0}) {
    const auto simulation = meeting(0.5, 40.0, spin, 0.3);
    EXPECT_GE(simulation->step().impacts, 1) << "spin " << spin;
    EXPECT_LT(pose(*simulation, 0).origin()[0], pose(*simulation, 1).origin()[0]);
  }
}

// Corners that narrowly pass each other.
TEST(EventMesh, AMissIsNone) {
  for (const double beside : {-1e-5, 1e-5}) {
    builder::ModelBuilder builder(events(20e-3, 1.0));
    rigid::RigidSettings body = cube(Kind::surface);
    body.gravity.setZero();
    body.velocity = Vector3(10.0, 0.0, 0.0);
    body.position = Vector3(-0.5, 0.0, 0.0);
    builder.add_body<rigid::RigidBodyModel>(body);
    body.name = "other";
    body.velocity.setZero();
    body.position = Vector3(0.0, kEdge + beside, 0.5 * kEdge);
    builder.add_body<rigid::RigidBodyModel>(body);
    add_pair(builder, 0, 1);
    sim::Simulation simulation(builder.build());
    int impacts = 0;
    for (int k = 0; k < 5; ++k) impacts += simulation.step().impacts;
    EXPECT_EQ(impacts > 0, beside < 0.0);
  }
}

TEST(EventMesh, StatesGoOnBitForBit) {
  const int pauses[] = {10, 15};
  expect_same_run(*dropped(Kind::surface, askew(), 10e-3, 0.6, 0.3), pauses, 5, 2);
}

}  // namespace
}  // namespace sinew::testing
