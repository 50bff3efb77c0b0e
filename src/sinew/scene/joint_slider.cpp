// Joints of type slider.
#include "sinew/constraint/joint_type.hpp"
#include "sinew/scene/joint_fields.hpp"
#include "sinew/scene/joint_kind.hpp"

namespace sinew::scene {

const JointKind& slider_kind() {
  using constraint::JointType;
  static const JointKind kind{.word = "slider",
                              .description = "Slides along an axis.",
                              .table =
                                  [] {
                                    return forms::rigid_joint_table(JointType::slider,
                                                                    slider_kind().description,
                                                                    {forms::joint_axis_key()});
                                  },
                              .read = read_simple_joint<JointType::slider>,
                              .add = add_rigid_joint};
  return kind;
}

}  // namespace sinew::scene
