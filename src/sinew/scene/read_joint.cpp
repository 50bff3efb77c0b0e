#include <algorithm>

#include "sinew/mesh/embedding.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace {

using constraint::JointType;

// The grammar allows no other word.
JointType type_of(const std::string& word) {
  return *std::ranges::find_if(constraint::kJointTypes, [&](JointType type) {
    return word == constraint::joint_type_name(type);
  });
}

void read_weld(const Fields& fields, JointDescription& weld, const ReadContext& context) {
  if (fields.find("region") != nullptr) weld.region = read_region(fields.below("region"));
  if (fields.find("points") != nullptr) weld.points = read_points(fields, "points", context);
  fields.read_choice("outside", weld.outside,
                     {{"error", mesh::Outside::error}, {"nearest", mesh::Outside::nearest}});
}

void read_axes_of(const Fields& fields, JointDescription& joint) {
  if (const Key* axis = fields.table().find("axis")) {
    joint.axis = read_axis(*fields.find("axis"), axis->forms);
  }
  if (const Key* axes = fields.table().find("axes")) {
    const std::vector<Form>& forms = axes->forms.front().items;
    joint.axis = read_axis(fields.find("axes")->items()[0], forms);
    joint.second_axis = read_axis(fields.find("axes")->items()[1], forms);
  }
}

void read_limits(const Fields& fields, JointDescription& joint) {
  const Fields limits = fields.below("limits");
  const auto read = [&](const char* motion, model::Limits& limit) {
    if (limits.table().find(motion) == nullptr) return;
    const Fields stops = limits.below(motion);
    stops.read("min", limit.min);
    stops.read("max", limit.max);
  };
  read("angle", joint.angle);
  read("displacement", joint.displacement);
}

}  // namespace

JointDescription read_joint(const Node::Entry& entry, const ReadContext& context) {
  JointDescription joint;
  joint.name = entry.key;
  joint.place = entry.key_place;
  const Form& form = form_of(grammar(), "joints", Shape::names).items.front();
  const Fields fields(entry.value, form);
  joint.type = type_of(read_text(*entry.value.find(form.telltale)));
  const Node& bodies = *fields.find("bodies");
  joint.first = read_text(bodies.items()[0]);
  joint.second = read_text(bodies.items()[1]);
  joint.bodies_place = bodies.place();
  if (joint.type == JointType::weld) {
    read_weld(fields, joint, context);
    return joint;
  }
  fields.read("point", joint.point);
  read_axes_of(fields, joint);
  if (fields.table().find("limits") != nullptr) read_limits(fields, joint);
  if (fields.table().find("friction") != nullptr) fields.read("friction", joint.friction);
  return joint;
}

}  // namespace sinew::scene
