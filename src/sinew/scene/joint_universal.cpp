// Joints of type universal.
#include <memory>
#include <utility>
#include <vector>

#include "sinew/constraint/joint_type.hpp"
#include "sinew/scene/grammar_forms.hpp"
#include "sinew/scene/joint_fields.hpp"
#include "sinew/scene/joint_kind.hpp"

namespace sinew::scene {

namespace forms {
namespace {

std::shared_ptr<const KeyTable> universal_table() {
  return rigid_joint_table(constraint::JointType::universal, universal_kind().description,
                           {{.name = "axes",
                             .forms = {list({vector(plain_number())}, 2, 2)},
                             .example = "[1 0 0, 0 1 0]",
                             .description = "The axis fixed in the first body and the one fixed in "
                                            "the second, normal to each other.",
                             .required = true}});
}

}  // namespace
}  // namespace forms

namespace {

void read_universal(const Fields& fields, const ReadContext& /*context*/, JointDescription& joint) {
  builder::JointSettings own = read_rigid_joint(constraint::JointType::universal, fields);
  const std::vector<Form>& forms = fields.form("axes").items;
  own.axis = read_axis(fields.find("axes")->items()[0], forms);
  own.second_axis = read_axis(fields.find("axes")->items()[1], forms);
  joint.own = std::move(own);
}

}  // namespace

const JointKind& universal_kind() {
  static const JointKind kind{.word = "universal",
                              .description = "Turns about two axes, one fixed in each body.",
                              .table = forms::universal_table,
                              .read = read_universal,
                              .add = [](const JointSite& site) { return add_rigid_joint(site); }};
  return kind;
}

}  // namespace sinew::scene
