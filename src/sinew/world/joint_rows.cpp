#include "sinew/world/joint_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/constraint/constraint.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/model/model.hpp"

namespace sinew::world {

JointRows::JointRows(const model::Model& model) : size_(model.size()) {
  const auto row_of = [&](int constraint) { return model.constraint(constraint).first_row(); };
  std::vector<std::size_t> first;  // first motion of each joint
  for (std::size_t j = 0; j < model.joints().size(); ++j) {
    const model::JointModel& joint = model.joints()[j];
    first.push_back(motions_.size());
    for (std::size_t which = 0; which < joint.motions.size(); ++which) {
      if (joint.motions[which] < 0) continue;
      const std::size_t own = motions_.size();
      const model::Limits& limits = joint.limits[which];
      motions_.push_back({static_cast<int>(j), which, row_of(joint.motions[which])});
      if (which == 0) angles_.push_back({motions_.back().row, own});
      if (std::isfinite(limits.min) || std::isfinite(limits.max)) {
        stops_.push_back({own, motions_.back().row, limits.min, limits.max});
      }
    }
    if (joint.brake < 0) continue;
    const Motion& braked = motions_[first.back()];
    brakes_.push_back({first.back(), row_of(joint.brake), -joint.friction, joint.friction});
    if (braked.which == 0) angles_.push_back({brakes_.back().row, first.back()});
  }
  for (const model::ActuatorModel& actuator : model.actuators()) {
    if (actuator.joint < 0) continue;
    const std::size_t motion = first[static_cast<std::size_t>(actuator.joint)];
    if (motions_[motion].which == 0) angles_.push_back({actuator.row, motion});
  }
  restart();
}

double JointRows::value(int joint, std::size_t motion) const {
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    if (motions_[m].joint == joint && motions_[m].which == motion) return values_[m];
  }
  return 0.0;
}

void JointRows::unwrap(VectorX& delta) const {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (const AngleRow& angle : angles_) {
    double& now = delta[angle.row];
    now += kTurn * std::round((values_[angle.motion] - now) / kTurn);
  }
}

void JointRows::form_blocks(const VectorX& delta, std::span<law::ActuatorBlock> blocks) const {
  std::size_t next = 0;
  for (const Block& stop : stops_) {
    law::ActuatorBlock& block = blocks[next++] = {};
    block.row = stop.row;
    block.effort_min = -kInfinity;
    block.effort_max = kInfinity;
    block.motion_min = stop.low;
    block.motion_max = stop.high;
    block.motion_scale = scale_of(motions_[stop.motion]);
  }
  for (const Block& brake : brakes_) {
    law::ActuatorBlock& block = blocks[next++] = {};
    block.row = brake.row;
    block.effort_min = brake.low;
    block.effort_max = brake.high;
    block.motion_min = -kInfinity;
    block.motion_max = kInfinity;
    block.kind = law::CommandKind::motion;
    block.value = delta[brake.row];
    block.motion_scale = scale_of(motions_[brake.motion]);
  }
}

void JointRows::accept(const VectorX& delta) {
  for (std::size_t m = 0; m < motions_.size(); ++m) values_[m] = delta[motions_[m].row];
}

void JointRows::restart() { values_.assign(motions_.size(), 0.0); }

}  // namespace sinew::world
