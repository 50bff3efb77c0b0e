// Bodies that pass curved surfaces: no force if they miss, no penetration if they hit.
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/contact/contact_state.hpp"
#include "sinew/fem/fem_body_model.hpp"
#include "sinew/fem/fem_body_settings.hpp"
#include "sinew/model/base_motion.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/run/contact_reader.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "contact_robots.hpp"

namespace sinew::sim {
namespace {

using mechanics::Integrator;
using sinew::testing::BlockOptions;
using sinew::testing::mean_velocity;

struct Flight {
  collision::Shape surface;
  double speed = 1.0;       ///< m/s, of the block along x
  double time_step = 0.01;  ///< s
  model::Method method = model::Method::newton;
  Integrator integrator = Integrator::backward_euler;
  std::optional<model::BaseMotion> motion;  ///< of the surface
};

/// A free block, 40 x 40 x 20 mm, centred over the origin, its bottom at z = 0; every node may
/// touch.
std::unique_ptr<Simulation> flying(const Flight& flight) {
  BlockOptions options{.floor = false};
  options.step.time_step = flight.time_step;
  options.step.method = flight.method;
  options.step.integrator = flight.integrator;
  builder::ModelBuilder builder(options.step);
  fem::FemBodySettings body;
  body.name = "block";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.corner = {-0.02, -0.02, 0.0}, .size = {0.04, 0.04, 0.02}, .cells = {4, 4, 2}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e6, 0.3}, material::Law::corotational, 1000.0, {}}};
  builder.add_body<fem::FemBodyModel>(std::move(body));
  builder::ContactSettings contact;
  contact.name = "obstacle";
  contact.surface = flight.surface;
  contact.friction = 0.3;
  contact.motion = flight.motion;
  for (Eigen::Index n = 0; n < mesh->nodes.rows(); ++n) {
    contact.nodes.push_back(static_cast<NodeId>(n));
  }
  builder.add_contact(contact);
  auto simulation = std::make_unique<Simulation>(builder.build());
  run::State state = simulation->state();
  const auto size = static_cast<std::size_t>(mesh->nodes.size());
  for (std::size_t i = 0; i < size; i += 3) state.bodies[0][size + i] = flight.speed;
  simulation->restore(state);
  return simulation;
}

std::vector<collision::Shape> obstacles(double x, double below) {
  const double radius = 0.005, z = -below - radius;
  return {collision::Sphere{{x, 0.0, z}, radius},
          collision::Capsule{{x, -0.01, z}, {x + 0.004, 0.01, z}, radius},
          collision::Capsule{{x, -0.3, z}, {x, 0.3, z}, radius}};  // a rod across the path
}

TEST(Passing, BodiesThatMissFeelNothing) {
  struct Case {
    double speed, time_step, below;
  };
  for (const Case& c : {Case{1.0, 0.01, 0.003}, Case{1.0, 0.01, 0.0005}, Case{3.0, 0.01, 0.01},
                        Case{10.0, 0.01, 0.04}, Case{1.0, 0.001, 0.0001}}) {
    for (const double phase : {0.0, 0.3, 0.7}) {
      const double x = 0.06 + phase * c.speed * c.time_step;
      for (const collision::Shape& surface : obstacles(x, c.below)) {
        for (const model::Method method :
             {model::Method::one_linearisation, model::Method::newton}) {
          const auto flown = flying(
              {.surface = surface, .speed = c.speed, .time_step = c.time_step, .method = method});
          Simulation& simulation = *flown;
          const auto steps = std::lround(0.16 / c.speed / c.time_step) + 1;
          for (long k = 0; k < steps; ++k) {
            simulation.step();
            ASSERT_EQ(simulation.contacts().resultant(0).normal_force, 0.0)
                << c.speed << " m/s, " << c.time_step << " s, surface " << surface.index();
          }
          EXPECT_LT((mean_velocity(simulation) - c.speed * Vector3::UnitX()).norm(),
                    1e-9 * c.speed);
        }
      }
    }
  }
}

// The same relative motion, made by the surface: it passes a body at rest.
TEST(Passing, SurfacesThatMissAreNotFelt) {
  for (const collision::Shape& surface : obstacles(0.06, 0.001)) {
    model::BaseMotion motion;
    motion.translation[0] = model::Signal::ramp({0.0, -0.12, 0.0, 0.12});
    const auto flown = flying({.surface = surface, .speed = 0.0, .motion = motion});
    Simulation& simulation = *flown;
    for (int k = 0; k < 13; ++k) {
      simulation.step();
      EXPECT_EQ(simulation.contacts().resultant(0).normal_force, 0.0);
    }
    EXPECT_LT(mean_velocity(simulation).norm(), 1e-15);
  }
}

/// x coordinate of the centre of the block's front, m.
double front(const Simulation& simulation) {
  const mechanics::Body& body = simulation.body(0);
  const Points& rest = body.model().mesh().nodes;
  for (Eigen::Index n = 0; n < rest.rows(); ++n) {
    if ((rest.row(n).transpose() - Vector3(0.02, 0.0, 0.01)).norm() < 1e-9) {
      return body.positions()(n, 0);
    }
  }
  return NAN;
}

// A step that would carry the block's front past the obstacle stops at it.
TEST(Passing, NothingGoesThroughASurface) {
  for (const double speed : {1.0, 5.0}) {
    for (const double phase : {0.0, 0.3, 0.7}) {
      const double x = 0.03 + phase * speed * 0.01, radius = 0.004;
      const collision::Sphere ball{{x, 0.0, 0.01}, radius};
      const collision::Capsule bar{{x, -0.3, 0.01}, {x, 0.3, 0.01}, radius};
      for (const collision::Shape& surface : {collision::Shape(ball), collision::Shape(bar)}) {
        for (const model::Method method :
             {model::Method::one_linearisation, model::Method::newton}) {
          const auto flown = flying({.surface = surface, .speed = speed, .method = method});
          Simulation& simulation = *flown;
          const double start = simulation.energies().kinetic;
          bool touched = false;
          for (int k = 0; k < 4; ++k) {
            simulation.step(OnFailure::keep_going);  // one linearisation leaves up to 36 %
            const contact::ContactResultant resultant = simulation.contacts().resultant(0);
            EXPECT_GE(resultant.smallest_gap, -1e-9);
            // Allows a fraction of a millimetre of slip. Later, or in later Newton iterations, the
            // front may slip off sideways, since a ball in front of its middle gives no stable
            // rest.
            if (!touched && method == model::Method::one_linearisation) {
              EXPECT_LT(front(simulation), x - radius + 1e-4);
            }
            // In a subdivided step it may touch and slip off.
            touched |= resultant.normal_force > 0.0 || mean_velocity(simulation)[0] < 0.9 * speed;
          }
          EXPECT_TRUE(touched);
          const mechanics::Energies energies = simulation.energies();
          EXPECT_LT(energies.kinetic + energies.strain, start);
          EXPECT_LT(mean_velocity(simulation)[0], 0.5 * speed);
        }
      }
    }
  }
}

// When the lower front edge hits a ball, the normal is that at the place of impact, for any step:
// the ball's centre is 3 mm below and 4 mm beyond the edge.
TEST(Passing, ImpactsAreThoseOfThePlaceWhereTheyHappen) {
  const collision::Sphere ball{{0.045, 0.0, -0.003}, 0.005};
  for (const double time_step : {1e-3, 4e-3, 1e-2}) {
    for (const model::Method method : {model::Method::one_linearisation, model::Method::newton}) {
      const auto flown =
          flying({.surface = ball, .speed = 1.0, .time_step = time_step, .method = method});
      Simulation& simulation = *flown;
      while (!(simulation.contacts().resultant(0).normal_force > 0.0)) {
        ASSERT_LT(simulation.time(), 0.05);
        simulation.step(OnFailure::keep_going);  // one linearisation leaves 13 % of the forces
      }
      double most = 0.0;
      Vector3 normal = Vector3::Zero();
      for (const contact::ContactPoint& point : simulation.contacts().points(0)) {
        if (point.normal_force <= most) continue;
        most = point.normal_force;
        normal = point.normal;
      }
      // Newton's method takes the tangent planes from the paths predicted by its last iterate,
      // which the impact bends.
      const double bent = method == model::Method::newton ? 40.0 * time_step : 1e-6;
      EXPECT_LT((normal - Vector3(-0.8, 0.0, 0.6)).norm(), bent) << time_step;
    }
  }
}

TEST(Passing, RunsGoOnFromASavedStateBitForBit) {
  const Flight flight{.surface = collision::Sphere{{0.035, 0.0, -0.003}, 0.005}};
  for (const Integrator integrator : {Integrator::backward_euler, Integrator::bdf2}) {
    Flight own = flight;
    own.integrator = integrator;
    const auto whole = flying(own), first = flying(own), second = flying(own);
    for (int k = 0; k < 12; ++k) whole->step();
    for (int k = 0; k < 3; ++k) first->step();
    run::State state = first->state();
    second->restore(state);
    for (int k = 0; k < 9; ++k) second->step();
    EXPECT_EQ(second->state().hash(), whole->state().hash());
    EXPECT_LT(mean_velocity(*whole)[0], 0.99);  // contact occurred
  }
}

std::size_t allocated() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

// Memory of one more simulation of a plate, all of whose nodes may touch a plane far below.
std::size_t memory_of_a_simulation(bool contact) {
  builder::ModelBuilder builder({.time_step = 0.01, .integrator = Integrator::backward_euler});
  fem::FemBodySettings body;
  body.name = "plate";
  const auto mesh = std::make_shared<const mesh::Mesh>(
      mesh::block({.size = {0.2, 0.2, 0.01}, .cells = {26, 26, 1}}));
  body.mesh = mesh;
  body.elements.regions = {{{1e6, 0.3}, material::Law::corotational, 1000.0, {}}};
  builder.add_body<fem::FemBodyModel>(std::move(body));
  if (contact) {
    builder::ContactSettings floor;
    floor.name = "floor";
    floor.surface = collision::Plane{{0.0, 0.0, -1.0}, Vector3::UnitZ()};
    for (Eigen::Index n = 0; n < mesh->nodes.rows(); ++n) {
      floor.nodes.push_back(static_cast<NodeId>(n));
    }
    builder.add_contact(floor);
  }
  const auto model = builder.build();
  const std::size_t before = allocated();
  Simulation simulation(model);
  for (int k = 0; k < 3; ++k) simulation.step();
  return allocated() - before;
}

TEST(ContactPassing, PointsThatNeverTouchTakeLittleMemory) {
  const std::size_t without = memory_of_a_simulation(false);
  if (without == 0) GTEST_SKIP() << "this build counts no allocations";
  const std::size_t with = memory_of_a_simulation(true);  // 1458 points
  EXPECT_GT(without, std::size_t{1} << 20U);
  EXPECT_LT(with, without + 5000000);
}

}  // namespace
}  // namespace sinew::sim
