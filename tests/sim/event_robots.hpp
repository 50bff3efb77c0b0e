// Rigid bodies for tests of impacts.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "sinew/collision/polyhedron.hpp"
#include "sinew/collision/shape.hpp"
#include "sinew/constraint/configuration.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/mesh.hpp"
#include "sinew/rigid/rigid_settings.hpp"
#include "sinew/rigid/shape.hpp"
#include "sinew/sim/contact_settings.hpp"
#include "sinew/sim/joint_settings.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/model_builder.hpp"
#include "sinew/sim/simulation.hpp"

#include "contact_robots.hpp"

namespace sinew::testing {

/// Settings of event-driven steps.
inline sim::StepSettings events(double time_step, double restitution) {
  return {.time_step = time_step,
          .integrator = mechanics::Integrator::event_driven,
          .restitution = restitution};
}

inline int add_ball(sim::ModelBuilder& builder, const std::string& name, const Vector3& at,
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
  return builder.add_rigid_body(ball);
}

/// Adds contact with the plane through the origin.
inline void add_floor(sim::ModelBuilder& builder, int body,
                      const Vector3& normal = Vector3::UnitZ(), double friction = 0.0) {
  sim::ContactSettings contact;
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
inline int add_slab(sim::ModelBuilder& builder, const std::string& name, bool as_mesh) {
  rigid::RigidSettings slab;
  slab.name = name;
  slab.shape = rigid::Box{{1.0, 1.0, 0.1}};
  if (as_mesh) slab.shape = triangles(slab.shape);
  slab.position = Vector3(0.0, 0.0, -0.05);
  slab.fixed = true;
  return builder.add_rigid_body(slab);
}

/// Distance at which triangles rest on those of the slab, m: 1e-7 of its diagonal.
inline const double kApart = 1e-7 * std::sqrt(2.01);

inline void add_pair(sim::ModelBuilder& builder, int first, int second, double friction = 0.0) {
  sim::ContactSettings contact;
  contact.name = "pair_" + std::to_string(first) + std::to_string(second);
  contact.body = first;
  contact.touched = second;
  contact.friction = friction;
  builder.add_contact(contact);
}

inline const mechanics::HasPose& pose(const sim::Simulation& simulation, int body) {
  return *mechanics::as<const mechanics::HasPose>(simulation.body(body));
}

}  // namespace sinew::testing
