// Joints of type ball.
#include "sinew/constraint/joint_type.hpp"
#include "sinew/scene/joint_fields.hpp"
#include "sinew/scene/joint_kind.hpp"

namespace sinew::scene {

const JointKind& ball_kind() {
  using constraint::JointType;
  static const JointKind kind{
      .word = "ball",
      .description = "Two points coincide.",
      .table =
          [] { return forms::rigid_joint_table(JointType::ball, ball_kind().description, {}); },
      .read = read_simple_joint<JointType::ball>,
      .add = add_rigid_joint};
  return kind;
}

}  // namespace sinew::scene
