// Reads and builds joints between rigid bodies.
#include <utility>

#include "sinew/builder/model_builder.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/scene/joint_fields.hpp"

namespace sinew::scene {

namespace {

void read_stops(const Fields& fields, builder::JointSettings& joint) {
  const Fields limits = fields.below("limits");
  const auto read = [&](const char* motion, model::Limits& limit) {
    if (!limits.may_have(motion)) return;
    const Fields stops = limits.below(motion);
    stops.read("min", limit.min);
    stops.read("max", limit.max);
  };
  read("angle", joint.angle);
  read("displacement", joint.displacement);
}

}  // namespace

builder::JointSettings read_rigid_joint(constraint::JointType type, const Fields& fields) {
  builder::JointSettings joint;
  joint.type = type;
  fields.read("point", joint.point);
  if (fields.may_have("limits")) read_stops(fields, joint);
  if (fields.may_have("friction")) fields.read("friction", joint.friction);
  return joint;
}

int add_rigid_joint(const JointSite& site) {
  return add_rigid_joint(site, *site.joint.as<builder::JointSettings>());
}

int add_rigid_joint(const JointSite& site, builder::JointSettings settings) {
  settings.name = site.joint.name;
  settings.place = site.joint.place;
  settings.first = site.body_of(site.joint.first).number;
  settings.second = site.body_of(site.joint.second).number;
  return site.builder.add_joint(settings);
}

bool is_rigid(const BuiltBody& body) {
  return body.model == nullptr || mechanics::as<const mechanics::HasShape>(*body.model) != nullptr;
}

}  // namespace sinew::scene
