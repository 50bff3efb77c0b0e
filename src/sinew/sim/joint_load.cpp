#include "sinew/sim/joint_load.hpp"

#include <Eigen/Geometry>

#include "sinew/constraint/configuration.hpp"
#include "sinew/constraint/joint.hpp"
#include "sinew/constraint/tie.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

namespace {

JointLoad load_of(const Simulation& simulation, const constraint::Tie& tie) {
  const constraint::Configuration& configuration = simulation.configuration();
  JointLoad load;
  load.gap = tie.largest_gap(configuration);
  for (const auto& pair : tie.pairs()) load.centre += configuration.position(pair.first);
  load.centre /= static_cast<double>(tie.pairs().size());
  for (std::size_t k = 0; k < tie.pairs().size(); ++k) {
    const Eigen::Map<const Vector3> force(simulation.efforts().data() + tie.row(k));
    load.force += force;
    load.moment +=
        (configuration.position(tie.pairs()[k].first) - load.centre).cross(Vector3(force));
  }
  return load;
}

JointLoad load_of(const Simulation& simulation, const constraint::Joint& joint) {
  const constraint::Configuration& configuration = simulation.configuration();
  const auto own = joint.load(
      configuration, simulation.efforts().subspan(static_cast<std::size_t>(joint.first_row()),
                                                  static_cast<std::size_t>(joint.row_count())));
  const constraint::JointFrames frames = joint.place().frames(configuration);
  return {frames.origin[1], own.force, own.moment, joint.gap(configuration)};
}

// 0 without a constraint.
double effort_of(const Simulation& simulation, int constraint) {
  if (constraint < 0) return 0.0;
  const int row = simulation.model().constraint(constraint).first_row();
  return simulation.efforts()[static_cast<std::size_t>(row)];
}

}  // namespace

JointLoad joint_load(const Simulation& simulation, int joint) {
  const Model& model = simulation.model();
  if (const constraint::Tie* tie = model.tie(joint)) return load_of(simulation, *tie);
  return load_of(simulation, *model.joint(joint));
}

double joint_motion(const Simulation& simulation, int joint, std::size_t motion) {
  return simulation.world().joints().value(joint, motion);
}

double joint_limit_effort(const Simulation& simulation, int joint, std::size_t motion) {
  const JointModel& model = simulation.model().joints()[static_cast<std::size_t>(joint)];
  return effort_of(simulation, model.motions.at(motion));
}

double joint_friction_effort(const Simulation& simulation, int joint) {
  return effort_of(simulation, simulation.model().joints()[static_cast<std::size_t>(joint)].brake);
}

}  // namespace sinew::sim
