// Rigid bodies for tests of impacts.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sinew/builder/contact_settings.hpp"
#include "sinew/builder/joint_settings.hpp"
#include "sinew/builder/model_builder.hpp"
#include "sinew/collision/polyhedron.hpp"
#include "sinew/collision/shape.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/model/model.hpp"
#include "sinew/rigid/rigid_body_model.hpp"
#include "sinew/rigid/rigid_settings.hpp"
#include "sinew/rigid/shape.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "contact_robots.hpp"

namespace sinew::testing {

/// Settings of event-driven steps.
inline model::StepSettings events(double time_step, double restitution) {
  return {.time_step = time_step,
          .integrator = mechanics::Integrator::event_driven,
          .restitution = restitution};
}

inline int add_ball(builder::ModelBuilder& builder, const std::string& name, const Vector3& at,
                    const Vector3& velocity = Vector3::Zero(),
                    const Vector3& gravity = Vector3(0.0, 0.0, -kGravity), double radius = 0.05,
                    const Vector3& spin = Vector3::Zero()) {
  rigid::RigidSettings ball;
  ball.name = name;
  ball.shape = rigid::Sphere{radius};
  ball.mass = 2.0;
  ball.position = at;
  ball.velocity = velocity;
  ball.spin = spin;
  ball.gravity = gravity;
  return builder.add_body<rigid::RigidBodyModel>(ball);
}

/// Adds contact with the plane through the origin.
inline void add_floor(builder::ModelBuilder& builder, int body,
                      const Vector3& normal = Vector3::UnitZ(), double friction = 0.0) {
  builder::ContactSettings contact;
  contact.name = "floor_" + std::to_string(body);
  contact.body = body;
  contact.surface = collision::Plane{Vector3::Zero(), normal};
  contact.friction = friction;
  builder.add_contact(contact);
}

/// A solid made of the triangles of a shape. @param convex whether contacts use the convex hull.
inline rigid::Solid triangles(const rigid::Shape& shape, bool convex = false) {
  rigid::Solid solid;
  solid.surface = std::make_shared<const mesh::Surface>(rigid::bounding_triangles(shape));
  if (convex) solid.hull = std::make_shared<const collision::Polyhedron>(solid.surface->nodes);
  return solid;
}

/// Adds a fixed slab of 1 x 1 x 0.1 m whose upper side is at z = 0, as a shape or as triangles.
inline int add_slab(builder::ModelBuilder& builder, const std::string& name, bool as_mesh) {
  rigid::RigidSettings slab;
  slab.name = name;
  slab.shape = rigid::Box{{1.0, 1.0, 0.1}};
  if (as_mesh) slab.shape = triangles(slab.shape);
  slab.position = Vector3(0.0, 0.0, -0.05);
  slab.fixed = true;
  return builder.add_body<rigid::RigidBodyModel>(slab);
}

/// Distance at which triangles rest on those of the slab, m: 1e-7 of its diagonal.
inline const double kApart = 1e-7 * std::sqrt(2.01);

inline void add_pair(builder::ModelBuilder& builder, int first, int second, double friction = 0.0) {
  builder::ContactSettings contact;
  contact.name = "pair_" + std::to_string(first) + std::to_string(second);
  contact.body = first;
  contact.touched = second;
  contact.friction = friction;
  builder.add_contact(contact);
}

inline const mechanics::HasPose& pose(const sim::Simulation& simulation, int body) {
  return *mechanics::as<const mechanics::HasPose>(simulation.body(body));
}

/// Expects that body 0, which tumbles, comes to rest within 3 s, and that its energy never grows by
/// more than the error of the midpoint rule while it turns about an edge.
/// @param simulation with the body. @param fall J, m g h. @param height m, of its origin at rest.
/// @param off m, tolerance of the height.
/// @param rate upper bound of the sum of its linear (m/s) and angular (rad/s) speeds at rest.
inline void expect_rest(sim::Simulation& simulation, double fall, double height, double off,
                        double rate) {
  double energy = simulation.energies().total();
  while (simulation.time() < 3.0) {
    simulation.step();
    const double now = simulation.energies().total();
    EXPECT_LE(now, energy + 1e-6 * fall) << "at " << simulation.time();
    energy = now;
  }
  const mechanics::HasPose& body = pose(simulation, 0);
  EXPECT_NEAR(body.origin()[2], height, off);
  EXPECT_LT(body.linear_velocity().norm() + body.angular_velocity().norm(), rate);
}

/// Expects that a run continues from a saved state bit for bit: in a clone, in a simulation with
/// another number of threads, in both again after restore(), and from the start after reset().
/// @param simulation is advanced. @param pauses numbers of steps to take before each saved state.
/// @param further steps to compare. @param threads of the other simulation.
inline void expect_same_run(sim::Simulation& simulation, std::span<const int> pauses, int further,
                            int threads) {
  const auto advance = [](sim::Simulation& one, std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k) one.step();
  };
  const std::uint64_t start = simulation.state().hash();
  for (const int steps : pauses) {
    advance(simulation, steps);
    const run::State kept = simulation.state();
    sim::Simulation other(simulation.shared_model(), threads);
    other.restore(kept);
    const auto copy = simulation.clone();
    advance(simulation, further);
    const run::State expected = simulation.state();
    for (sim::Simulation* twin : {&other, copy.get()}) {
      advance(*twin, further);
      EXPECT_TRUE(twin->state() == expected) << "from step " << kept.steps;
      EXPECT_EQ(twin->state().hash(), expected.hash());
      twin->restore(kept);
      advance(*twin, further);
      EXPECT_TRUE(twin->state() == expected) << "again from step " << kept.steps;
    }
  }
  const run::State end = simulation.state();
  simulation.reset();
  EXPECT_EQ(simulation.state().hash(), start);
  advance(simulation, end.steps);
  EXPECT_TRUE(simulation.state() == end);
}

}  // namespace sinew::testing
