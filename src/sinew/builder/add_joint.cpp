#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "sinew/builder/add_parts.hpp"
#include "sinew/builder/find_body.hpp"
#include "sinew/builder/joint_settings.hpp"
#include "sinew/builder/motor_settings.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/core/error.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/mesh/embedding.hpp"
#include "sinew/model/model_data.hpp"
#include "sinew/model/new_name.hpp"

namespace sinew::builder {

namespace {

using constraint::JointMotion;
using constraint::JointPlace;
using constraint::JointSide;
using constraint::JointType;

// Tolerance on the perpendicularity of two axes, rad.
constexpr double kNormal = 1e-6;

[[noreturn]] void refuse(const JointSettings& joint, ErrorKind kind, const std::string& what,
                         const std::string& remedy) {
  throw Error(kind, joint.place, what, remedy);
}

// Whether a joint has a motion, in the order of JointModel::motions.
bool has(JointType type, std::size_t motion) {
  return motion == 0 ? constraint::turns_about_axis(type) : constraint::slides_along_axis(type);
}

// A body without rigid parts can only take the point of a ball joint.
JointSide side_of(model::ModelData& data, const JointSettings& joint, int body) {
  JointSide side;
  side.rest = joint.point;
  if (body == model::kWorld) return side;
  mechanics::BodyModel& on = find_body(data, body, joint.place);
  const std::string what = "joint '" + joint.name + "'";
  auto* rigid = mechanics::as<mechanics::AttachesOrientations>(on);
  // A joint may lie outside the part that carries it: brackets are not modelled.
  const auto outside = rigid == nullptr ? mesh::Outside::error : mesh::Outside::nearest;
  side.point = {{body, on.attach(joint.point, outside, what)}};
  if (joint.type == JointType::ball) return side;
  if (rigid == nullptr) {
    refuse(joint, ErrorKind::wrong_type,
           fmt::format("body '{}' deforms, so it has no axis to hold a {} joint", on.name(),
                       constraint::joint_type_name(joint.type)),
           "weld a rigid body to it and join that one, or use a ball joint");
  }
  side.orientation = {{body, rigid->attach_orientation(joint.point, outside, what)}};
  return side;
}

Matrix3 axes_of(const JointSettings& joint) {
  const double length = joint.axis.norm();
  if (!(length > 0.0) || !std::isfinite(length)) {
    refuse(joint, ErrorKind::out_of_range, "its axis has no direction", "give one such as 0 0 1");
  }
  const Vector3 axis = joint.axis / length;
  Vector3 side = axis.unitOrthogonal();
  if (joint.type == JointType::universal) {
    side = joint.second_axis.normalized();
    if (!(std::abs(side.dot(axis)) <= kNormal)) {
      refuse(joint, ErrorKind::out_of_range, "its two axes are not normal to each other",
             "give axes such as [1 0 0, 0 1 0]");
    }
  }
  Matrix3 axes;
  axes << side, axis.cross(side), axis;
  return axes;
}

void check_limits(const JointSettings& joint, const model::Limits& limits, const char* what,
                  bool may) {
  const bool given = std::isfinite(limits.min) || std::isfinite(limits.max);
  if (given && !may) {
    refuse(
        joint, ErrorKind::conflicting_keys,
        fmt::format("a {} joint has no {} to limit", constraint::joint_type_name(joint.type), what),
        "leave the limit out");
  }
  if (limits.min <= 0.0 && limits.max >= 0.0) return;
  refuse(joint, ErrorKind::contradictory_limits,
         fmt::format("its {} is 0 where the scene puts the bodies, outside {:g} to {:g}", what,
                     limits.min, limits.max),
         "give limits around zero, from where the bodies are at the start");
}

void check(const model::ModelData& data, const JointSettings& joint) {
  model::check_new_name(data.joints, &model::JointModel::name, "joints", joint.name, joint.place);
  if (joint.first == joint.second) {
    refuse(joint, ErrorKind::bad_argument, "a joint needs two bodies, and these are one",
           "name two bodies, or one and `world`");
  }
  check_limits(joint, joint.angle, "angle", has(joint.type, 0));
  check_limits(joint, joint.displacement, "displacement", has(joint.type, 1));
  if (joint.friction == 0.0) return;
  if (!(joint.friction > 0.0) || !std::isfinite(joint.friction)) {
    refuse(joint, ErrorKind::out_of_range, fmt::format("its friction is {:g}", joint.friction),
           "give the moment or force, zero or more, that it takes to move it");
  }
  if (joint.type == JointType::hinge || joint.type == JointType::slider) return;
  refuse(joint, ErrorKind::not_in_this_version,
         fmt::format("friction of a {} joint", constraint::joint_type_name(joint.type)),
         "hinges and sliders have friction");
}

const char* motion_word(std::size_t motion) { return motion == 0 ? "angle" : "displacement"; }

}  // namespace

int add_joint(model::ModelData& data, const JointSettings& settings) {
  check(data, settings);
  try {
    const JointPlace place(side_of(data, settings, settings.first),
                           side_of(data, settings, settings.second), axes_of(settings));
    model::JointModel joint;
    joint.name = settings.name;
    joint.first = settings.first;
    joint.second = settings.second;
    joint.limits = {settings.angle, settings.displacement};
    joint.friction = settings.friction;
    joint.constraint =
        data.declare(std::make_unique<constraint::Joint>(settings.name, settings.type, place));
    const auto row = [&](std::size_t motion) {
      const auto kind = motion == 0 ? JointMotion::Kind::angle : JointMotion::Kind::displacement;
      return data.declare(
          std::make_unique<JointMotion>(settings.name + "." + motion_word(motion), kind, place));
    };
    for (std::size_t motion = 0; motion < joint.motions.size(); ++motion) {
      if (has(settings.type, motion)) joint.motions[motion] = row(motion);
    }
    if (settings.friction > 0.0) joint.brake = row(joint.motions[0] >= 0 ? 0 : 1);
    data.joints.push_back(std::move(joint));
    return static_cast<int>(data.joints.size()) - 1;
  } catch (const Error& error) {
    throw error.at(settings.place);
  }
}

int add_motor(model::ModelData& data, const MotorSettings& settings) {
  const model::JointModel& joint = data.joints.at(static_cast<std::size_t>(settings.joint));
  const auto* held = dynamic_cast<const constraint::Joint*>(&data.constraint(joint.constraint));
  const JointType type = held == nullptr ? JointType::weld : held->type();
  const bool turns = !settings.linear;
  if (type != (turns ? JointType::hinge : JointType::slider)) {
    throw Error(ErrorKind::wrong_type, settings.place,
                fmt::format("joint '{}' is a {}", joint.name, constraint::joint_type_name(type)),
                turns ? "a motor moves a hinge; a linear-motor moves a slider"
                      : "a linear-motor moves a slider; a motor moves a hinge");
  }
  model::ActuatorModel motor{settings.name, turns ? &kMotorKind : &kLinearMotorKind};
  motor.effort = settings.effort;
  motor.motion = settings.motion;
  motor.command = settings.command;
  motor.motion_scale = turns ? data.size : 1.0;
  motor.joint = settings.joint;
  const auto kind = turns ? JointMotion::Kind::angle : JointMotion::Kind::displacement;
  return add_actuator(data, std::move(motor),
                      std::make_unique<JointMotion>(settings.name, kind, held->place()),
                      settings.place);
}

}  // namespace sinew::builder
