#include "sinew/sim/joint_load.hpp"

#include <array>

#include <Eigen/Geometry>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/row_efforts.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

namespace {

JointLoad load_of(const Simulation& simulation, const constraint::Tie& tie) {
  const constraint::Configuration& configuration = simulation.configuration();
  JointLoad load;
  load.gap = tie.largest_gap(configuration);
  for (const auto& pair : tie.pairs()) load.centre += configuration.position(pair.first);
  load.centre /= static_cast<double>(tie.pairs().size());
  for (std::size_t k = 0; k < tie.pairs().size(); ++k) {
    const Vector3 force{end_effort(simulation, tie.row(k)), end_effort(simulation, tie.row(k) + 1),
                        end_effort(simulation, tie.row(k) + 2)};
    load.force += force;
    load.moment += (configuration.position(tie.pairs()[k].first) - load.centre).cross(force);
  }
  return load;
}

JointLoad load_of(const Simulation& simulation, const constraint::Joint& joint) {
  const constraint::Configuration& configuration = simulation.configuration();
  std::array<double, 6> effort{};
  const auto held = std::span(effort).first(static_cast<std::size_t>(joint.row_count()));
  for (std::size_t k = 0; k < held.size(); ++k) {
    held[k] = end_effort(simulation, joint.first_row() + static_cast<int>(k));
  }
  const auto own = joint.load(configuration, held);
  const constraint::JointFrames frames = joint.place().frames(configuration);
  return {frames.origin[1], own.force, own.moment, joint.gap(configuration)};
}

// 0 without a constraint.
double effort_of(const Simulation& simulation, int constraint) {
  if (constraint < 0) return 0.0;
  return end_effort(simulation, simulation.model().constraint(constraint).first_row());
}

}  // namespace

JointLoad joint_load(const Simulation& simulation, int joint) {
  const model::Model& model = simulation.model();
  if (const constraint::Tie* tie = model.tie(joint)) return load_of(simulation, *tie);
  return load_of(simulation, *model.joint(joint));
}

double joint_motion(const Simulation& simulation, int joint, std::size_t motion) {
  return simulation.world().joints().value(joint, motion);
}

double joint_limit_effort(const Simulation& simulation, int joint, std::size_t motion) {
  const model::JointModel& model = simulation.model().joints()[static_cast<std::size_t>(joint)];
  return effort_of(simulation, model.motions.at(motion));
}

double joint_friction_effort(const Simulation& simulation, int joint) {
  return effort_of(simulation, simulation.model().joints()[static_cast<std::size_t>(joint)].brake);
}

}  // namespace sinew::sim
