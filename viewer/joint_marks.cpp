#include "joint_marks.hpp"

#include "sinew/constraint/joint.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/joint_load.hpp"

namespace sinew::viewer {

namespace {

using constraint::JointType;

struct Marks {
  Vector3 first, second;                  // m
  Vector3 axis = Vector3::Zero();         // fixed in the first body
  Vector3 second_axis = Vector3::Zero();  // fixed in the second
};

Marks marks_of(const sim::Simulation& simulation, int index) {
  const constraint::Joint* joint = simulation.model().joint(index);
  if (joint == nullptr) {
    const Vector3 centre = sim::joint_load(simulation, index).centre;
    return {centre, centre};
  }
  const auto frames = joint->place().frames(simulation.configuration());
  Marks marks{frames.origin[0], frames.origin[1]};
  const JointType type = joint->type();
  if (type != JointType::ball && type != JointType::weld) marks.axis = frames.axes[0].col(2);
  if (type == JointType::universal) marks.second_axis = frames.axes[1].col(0);
  return marks;
}

}  // namespace

std::vector<float> joint_marks(const sim::Simulation& simulation) {
  std::vector<float> result;
  for (std::size_t j = 0; j < simulation.model().joints().size(); ++j) {
    const Marks marks = marks_of(simulation, static_cast<int>(j));
    for (const Vector3& v : {marks.first, marks.second, marks.axis, marks.second_axis}) {
      for (int c = 0; c < 3; ++c) result.push_back(static_cast<float>(v[c]));
    }
  }
  return result;
}

}  // namespace sinew::viewer
