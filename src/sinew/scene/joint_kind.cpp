#include "sinew/scene/joint_kind.hpp"

#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/kind_list.hpp"
#include "sinew/scene/values.hpp"

namespace sinew::scene {

namespace {

KindList<JointKind>& kinds_of_joints() {
  static KindList<JointKind> list(
      "joint", {&weld_kind(), &ball_kind(), &hinge_kind(), &slider_kind(), &cylindrical_kind(),
                &universal_kind()});
  return list;
}

}  // namespace

void register_joint_kind(const JointKind& kind) { kinds_of_joints().add(kind); }

const JointKind& joint_kind(std::string_view word) { return kinds_of_joints().get(word); }

Form forms::joint_form() { return variants("type", kinds_of_joints().choices()); }

JointDescription read_joint(const Node::Entry& entry, const ReadContext& context) {
  JointDescription joint;
  joint.name = entry.key;
  joint.place = entry.key_place;
  const Form& form = form_of(grammar(), "joints", Shape::names).items.front();
  const Fields fields(entry.value, form);
  joint.kind = &joint_kind(read_text(*entry.value.find(form.telltale)));
  const Node& bodies = *fields.find("bodies");
  joint.first = read_text(bodies.items()[0]);
  joint.second = read_text(bodies.items()[1]);
  joint.bodies_place = bodies.place();
  joint.kind->read(fields, context, joint);
  return joint;
}

}  // namespace sinew::scene
