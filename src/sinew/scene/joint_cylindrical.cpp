// Joints of type cylindrical.
#include "sinew/constraint/joint_type.hpp"
#include "sinew/scene/joint_fields.hpp"
#include "sinew/scene/joint_kind.hpp"

namespace sinew::scene {

const JointKind& cylindrical_kind() {
  using constraint::JointType;
  static const JointKind kind{.word = "cylindrical",
                              .description = "Turns about an axis and slides along it.",
                              .table =
                                  [] {
                                    return forms::rigid_joint_table(JointType::cylindrical,
                                                                    cylindrical_kind().description,
                                                                    {forms::joint_axis_key()});
                                  },
                              .read = read_simple_joint<JointType::cylindrical>,
                              .add = add_rigid_joint};
  return kind;
}

}  // namespace sinew::scene
