#include "sinew/world/standing_blocks.hpp"

#include "sinew/constraint/joint.hpp"
#include "sinew/model/model.hpp"

namespace sinew::world {

law::StepProblem standing_blocks(const model::Model& model, std::size_t joint_actuators) {
  law::StepProblem problem;
  problem.size = model.size();
  problem.actuators.resize(model.actuators().size() + joint_actuators);
  for (const model::GuideModel& guide : model.guides()) {
    problem.capstans.push_back({guide.row, guide.actuator, 0.0, 0.0});
  }
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const constraint::Constraint& held = model.constraint(model.joints()[j].constraint);
    const constraint::Joint* joint = model.joint(static_cast<int>(j));
    for (int row = held.first_row(); row < held.first_row() + held.row_count(); ++row) {
      const bool turn = joint != nullptr && joint->is_turn(row);
      problem.bilaterals.push_back({row, 0.0, turn ? model.size() : 1.0});
    }
  }
  return problem;
}

}  // namespace sinew::world
