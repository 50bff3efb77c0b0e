/// @file
/// What several kinds of joints share. Internal to this folder and to kinds of joints.
#pragma once

#include <memory>
#include <vector>

#include "sinew/builder/joint_settings.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/joint_kind.hpp"

namespace sinew::scene {

namespace forms {

/// Key `bodies`. @param example of it. @param description of it.
Key bodies_key(const char* example, const char* description);
/// The table of a joint between rigid bodies: bodies, point, the keys of its axes, and limits and
/// friction of the motions that it leaves free.
/// @param type of the joint. @param description of it. @param axes keys; may be empty.
std::shared_ptr<const KeyTable> rigid_joint_table(constraint::JointType type,
                                                  const char* description, std::vector<Key> axes);
/// Key `axis`.
Key joint_axis_key();

}  // namespace forms

/// Reads the settings of a joint between rigid bodies, without its axes.
/// @param type of the joint. @param fields of it.
builder::JointSettings read_rigid_joint(constraint::JointType type, const Fields& fields);
/// JointKind::read of a joint with at most one axis. @tparam type of the joint.
template <constraint::JointType type>
void read_simple_joint(const Fields& fields, const ReadContext& /*context*/,
                       JointDescription& joint) {
  builder::JointSettings own = read_rigid_joint(type, fields);
  if (const Key* axis = fields.table().find("axis")) {
    own.axis = read_axis(*fields.find("axis"), axis->forms);
  }
  joint.own = std::move(own);
}
/// JointKind::add of a joint between rigid bodies. @param site whose settings are JointSettings.
int add_rigid_joint(const JointSite& site);
/// Adds such a joint. @param site of it. @param settings besides name and bodies.
int add_rigid_joint(const JointSite& site, builder::JointSettings settings);

}  // namespace sinew::scene
