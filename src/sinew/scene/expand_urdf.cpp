// Replaces robots in URDF files by bodies and joints of the scene.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "sinew/builder/joint_settings.hpp"
#include "sinew/constraint/joint_type.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/scene/actuator_kind.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/joint_kind.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/scene/urdf.hpp"
#include "sinew/scene/urdf_bodies.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace {

using Type = UrdfJoint::Type;

// The parts that scenes may name as ROBOT.NAME.
struct Names {
  std::map<std::string, std::string> bodies;  // the body that a link is part of
  std::map<std::string, UrdfJoint> joints;    // joints that move
};

JointDescription joint_of(const UrdfJoint& from, int number, const UrdfBodies& bodies,
                          const std::string& robot) {
  JointDescription joint;
  joint.name = robot + "." + from.name;
  joint.place = joint.bodies_place = from.place;
  joint.first = bodies.body_of(from.parent);
  joint.second = bodies.body_of(from.child);
  if (from.type == Type::fixed) {
    joint.kind = &weld_kind();
    joint.own = WeldDescription{};
    return joint;
  }
  const bool slides = from.type == Type::prismatic;
  joint.kind = slides ? &slider_kind() : &hinge_kind();
  builder::JointSettings own;
  own.type = slides ? constraint::JointType::slider : constraint::JointType::hinge;
  own.point = bodies.frame(from.child).translation();
  own.axis = bodies.frame(from.child).linear() * from.axis;
  model::Limits& limits = slides ? own.displacement : own.angle;
  limits.min = from.lower - bodies.start(number);
  limits.max = from.upper - bodies.start(number);
  own.friction = from.friction;
  joint.own = std::move(own);
  return joint;
}

// Expands one robot. @param scene to which its joints are added. @return its bodies.
std::vector<BodyDescription> expand(const BodyDescription& body, SceneDescription& scene,
                                    Names& names, std::vector<Notice>& notices) {
  const UrdfDescription& description = *body.as<UrdfDescription>();
  const UrdfRobot robot =
      parse_urdf(at_place(description.file_place, [&] { return read_file(description.file); }),
                 description.file.string());
  notices.insert(notices.end(), robot.notices.begin(), robot.notices.end());
  const UrdfBodies bodies(robot, description, body.name);
  for (std::size_t k = 0; k < robot.links.size(); ++k) {
    names.bodies[body.name + "." + robot.links[k].name] = bodies.body_of(static_cast<int>(k));
  }
  for (std::size_t k = 0; k < robot.joints.size(); ++k) {
    const UrdfJoint& joint = robot.joints[k];
    const bool merged = bodies.carrier(joint.parent) == bodies.carrier(joint.child);
    const bool held = joint.type == Type::fixed && bodies.is_fixed(joint.child);
    if (merged || held || joint.type == Type::floating) continue;
    scene.joints.push_back(joint_of(joint, static_cast<int>(k), bodies, body.name));
    names.joints[body.name + "." + joint.name] = joint;
  }
  return bodies.make(notices);
}

[[noreturn]] void throw_unknown(const std::string& name, const Location& place, const char* what,
                                const std::vector<std::string>& known) {
  throw Error(ErrorKind::unknown_name, place, fmt::format("the robot has no {} '{}'", what, name),
              fmt::format("{}there are {}", did_you_mean(name, known), join(known)));
}

template <class Value>
std::vector<std::string> keys_of(const std::map<std::string, Value>& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& entry : map) keys.push_back(entry.first);
  return keys;
}

// Calls rename(name, place) on every name of a body in the scene.
template <class Rename>
void for_each_body_name(SceneDescription& scene, Rename&& rename) {
  for (ActuatorDescription& actuator : scene.actuators) {
    rename(actuator.body, actuator.body_place);
    if (actuator.kind->bodies == nullptr) continue;
    const FurtherBodies further = actuator.kind->bodies(actuator.own);
    for (std::string& name : *further.names) rename(name, further.place);
  }
  for (LoadDescription& load : scene.loads) rename(load.body, load.place);
  for (MassDescription& mass : scene.masses) rename(mass.body, mass.body_place);
  for (MembraneDescription& layer : scene.membranes) rename(layer.body, layer.body_place);
  for (EffectorDescription& effector : scene.effectors) rename(effector.body, effector.body_place);
  for (ProbeDescription& probe : scene.probes) {
    for (SpotDescription& part : probe.parts) rename(part.body, part.place);
  }
  for (SensorDescription& sensor : scene.sensors) {
    rename(sensor.body, sensor.place);
    for (std::string& body : sensor.further_bodies) rename(body, sensor.place);
  }
  for (EstimatorDescription& estimator : scene.estimators) {
    for (UnknownDescription& unknown : estimator.unknowns) rename(unknown.body, unknown.place);
  }
  for (ContactDescription& contact : scene.contacts) {
    rename(contact.body, contact.place);
    rename(contact.other, contact.between_place);
    for (auto& [one, other] : contact.except) {
      rename(one, contact.between_place);
      rename(other, contact.between_place);
    }
  }
  for (JointDescription& joint : scene.joints) {
    rename(joint.first, joint.bodies_place);
    rename(joint.second, joint.bodies_place);
  }
}

void resolve_bodies(SceneDescription& scene, const Names& names,
                    const std::vector<std::string>& robots) {
  for_each_body_name(scene, [&](std::string& name, const Location& place) {
    if (std::ranges::find(robots, name) != robots.end()) {
      throw Error(ErrorKind::wrong_type, place,
                  fmt::format("'{}' is a robot of several bodies", name),
                  fmt::format("name one of its links: {}", join(keys_of(names.bodies))));
    }
    if (name.find('.') == std::string::npos) return;
    const auto body = names.bodies.find(name);
    if (body == names.bodies.end()) throw_unknown(name, place, "link", keys_of(names.bodies));
    name = body->second;
  });
}

// Resolves the joints of motors. Motors without limits get those of the file.
void resolve_joints(SceneDescription& scene, const Names& names) {
  for (ActuatorDescription& actuator : scene.actuators) {
    auto* motor = actuator.as<MotorDescription>();
    if (motor == nullptr || motor->joint.find('.') == std::string::npos) continue;
    const auto found = names.joints.find(motor->joint);
    if (found == names.joints.end()) {
      throw_unknown(motor->joint, motor->joint_place, "joint", keys_of(names.joints));
    }
    const UrdfJoint& joint = found->second;
    model::Limits &effort = motor->settings.effort, &motion = motor->settings.motion;
    if (std::isinf(effort.min) && std::isinf(effort.max)) {
      effort.min = -joint.effort;
      effort.max = joint.effort;
    }
    if (std::isinf(motion.rate)) motion.rate = joint.velocity;
  }
}

}  // namespace

std::vector<Notice> expand_urdf(SceneDescription& scene) {
  std::vector<Notice> notices;
  std::vector<BodyDescription> bodies;
  std::vector<std::string> robots;
  Names names;
  std::vector<JointDescription> own = std::move(scene.joints);
  scene.joints.clear();
  for (BodyDescription& body : scene.bodies) {
    if (body.as<UrdfDescription>() != nullptr) {
      robots.push_back(body.name);
      std::ranges::move(expand(body, scene, names, notices), std::back_inserter(bodies));
    } else {
      bodies.push_back(std::move(body));
    }
  }
  const auto added = std::exchange(scene.joints, std::move(own));
  scene.bodies = std::move(bodies);
  if (robots.empty()) return notices;
  resolve_bodies(scene, names, robots);
  resolve_joints(scene, names);
  scene.link_bodies = std::move(names.bodies);
  scene.joints.insert(scene.joints.end(), added.begin(), added.end());
  return notices;
}

}  // namespace sinew::scene
