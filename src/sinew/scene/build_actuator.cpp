#include <algorithm>

#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/cable_settings.hpp"
#include "sinew/sim/chamber_settings.hpp"
#include "sinew/sim/force_settings.hpp"
#include "sinew/sim/joint_settings.hpp"
#include "sinew/sim/model_builder.hpp"
#include "sinew/sim/spring_line_settings.hpp"
#include "sinew/sim/torque_settings.hpp"

namespace sinew::scene {

namespace {

void add_cable(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body,
               const BodyOf& body_of) {
  sim::CableSettings cable;
  cable.name = actuator.name;
  cable.place = actuator.place;
  cable.body = body;
  cable.points = actuator.points.points;
  cable.point_places = actuator.points.places;
  for (const std::string& name : actuator.points.bodies) {
    cable.point_bodies.push_back(name.empty() ? body : body_of(name).number);
  }
  cable.pull_from_world = actuator.pull == PullPoint::world;
  cable.outside = actuator.outside;
  cable.tension = actuator.effort;
  cable.tension.min = std::max(cable.tension.min, 0.0);
  cable.displacement = actuator.motion;
  cable.command = actuator.command;
  cable.geometric_stiffness = actuator.geometric_stiffness;
  cable.friction = actuator.friction;
  cable.guide_radius = actuator.guide_radius.value_or(0.0);
  cable.guide_spacing = actuator.guide_spacing;
  builder.add_cable(cable);
}

void add_force(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body) {
  sim::ForceSettings force;
  force.name = actuator.name;
  force.place = actuator.place;
  force.body = body;
  force.point = actuator.point;
  force.direction = actuator.direction;
  force.outside = actuator.outside;
  force.force = actuator.effort;
  force.displacement = actuator.motion;
  force.command = actuator.command;
  builder.add_force(force);
}

void add_spring(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body) {
  sim::SpringLineSettings line;
  line.name = actuator.name;
  line.place = actuator.place;
  line.body = body;
  line.points = actuator.points.points;
  line.point_places = actuator.points.places;
  line.pull_from_world = actuator.pull == PullPoint::world;
  line.outside = actuator.outside;
  line.spring = actuator.spring;
  line.free_at_rest = actuator.free_at_rest;
  line.command = actuator.command;
  builder.add_spring(line);
}

void add_chamber(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body,
                 const mesh::Mesh& mesh) {
  sim::ChamberSettings chamber;
  chamber.name = actuator.name;
  chamber.place = actuator.place;
  chamber.body = body;
  const SurfaceDescription& surface = actuator.surface;
  if (surface.kind == SurfaceDescription::Kind::file) {
    try {
      mesh::SurfaceOptions options;
      options.unit = surface.unit;
      const mesh::Surface read = mesh::read_surface(surface.file, options);
      mesh::require_closed(read);
      chamber.surface = read;
    } catch (const Error& error) {
      throw error.at(surface.place);
    }
  } else {
    chamber.surface = faces_of(surface, mesh);
  }
  chamber.outside = actuator.outside;
  chamber.cap = actuator.cap;
  chamber.load_stiffness = actuator.load_stiffness;
  chamber.pressure = actuator.effort;
  chamber.volume_growth = actuator.motion;
  chamber.command = actuator.command;
  chamber.gas = actuator.gas;
  chamber.liquid = actuator.liquid;
  builder.add_chamber(chamber);
}

void add_motor(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int joint) {
  sim::MotorSettings motor;
  motor.name = actuator.name;
  motor.place = actuator.place;
  motor.joint = joint;
  motor.linear = actuator.type == ActuatorDescription::Type::linear_motor;
  motor.effort = actuator.effort;
  motor.motion = actuator.motion;
  motor.command = actuator.command;
  builder.add_motor(motor);
}

void add_torque(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body) {
  sim::TorqueSettings torque;
  torque.name = actuator.name;
  torque.place = actuator.place;
  torque.body = body;
  torque.segment = actuator.segment;
  torque.towards = actuator.towards;
  torque.torque = actuator.effort;
  torque.angle = actuator.motion;
  torque.command = actuator.command;
  builder.add_torque(torque);
}

}  // namespace

void add_actuator(sim::ModelBuilder& builder, const ActuatorDescription& actuator,
                  const BodyOf& body_of, const JointOf& joint_of) {
  if (!actuator.joint.empty()) return add_motor(builder, actuator, joint_of(actuator.joint));
  const auto [body, model] = body_of(actuator.body);
  switch (actuator.type) {
    case ActuatorDescription::Type::cable:
      return add_cable(builder, actuator, body, body_of);
    case ActuatorDescription::Type::force:
      return add_force(builder, actuator, body);
    case ActuatorDescription::Type::pressure:
      return add_chamber(builder, actuator, body, model->mesh());
    case ActuatorDescription::Type::spring:
      return add_spring(builder, actuator, body);
    case ActuatorDescription::Type::torque:
      return add_torque(builder, actuator, body);
    case ActuatorDescription::Type::motor:
    case ActuatorDescription::Type::linear_motor:
      break;  // of joints, above
  }
}

}  // namespace sinew::scene
