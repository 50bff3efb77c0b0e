// Joints of type hinge.
#include "sinew/constraint/joint_type.hpp"
#include "sinew/scene/joint_fields.hpp"
#include "sinew/scene/joint_kind.hpp"

namespace sinew::scene {

const JointKind& hinge_kind() {
  using constraint::JointType;
  static const JointKind kind{.word = "hinge",
                              .description = "Turns about an axis.",
                              .table =
                                  [] {
                                    return forms::rigid_joint_table(JointType::hinge,
                                                                    hinge_kind().description,
                                                                    {forms::joint_axis_key()});
                                  },
                              .read = read_simple_joint<JointType::hinge>,
                              .add = add_rigid_joint};
  return kind;
}

}  // namespace sinew::scene
