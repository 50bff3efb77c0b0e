/// @file
/// Settings that all controllers of effectors have: their tasks and actuators.
#pragma once

#include <cmath>
#include <vector>

#include "sinew/control/target.hpp"

namespace sinew::sim {
class Simulation;
}

namespace sinew::control {

/// A task of one effector: its target, weights and priority.
struct EffectorTask {
  int effector = 0;
  Target target;
  /// Weights of squared distances, >= 0: one for all rows of the effector, or one each.
  std::vector<double> weights = {1.0};
  /// Priority; 1 comes first. The weights of each later priority are kLaterPriority times those of
  /// the one before. The remaining error of a task displaces one of the priority before by about
  /// this part of it, times the ratio of their sensitivities to the efforts.
  int priority = 1;

  static constexpr double kLaterPriority = 1e-4;

  /// Weight of a row of the effector, within its priority.
  double weight(Eigen::Index row) const {
    return weights[weights.size() == 1 ? 0 : static_cast<std::size_t>(row)];
  }
  /// Weight of a row among the rows of all tasks.
  double weight_by_priority(Eigen::Index row) const {
    return weight(row) * std::pow(kLaterPriority, priority - 1);
  }
};

/// What a controller steers, and by which actuators.
struct TargetSettings {
  std::vector<EffectorTask> tasks;
  std::vector<int> actuators;  ///< owned by the controller; empty: all
  /// m (or rad): an effector within this distance of its target is on target.
  double tolerance = 1e-4;
};

/// Checks the settings; if they name no actuators, selects all that a controller may own.
/// Throws Error: no-actuators, wrong-actuator-type, wrong-length (weights), out-of-range,
/// suspicious-unit. @param simulation to be steered. @param settings that may have no tasks.
void check_settings(const sim::Simulation& simulation, TargetSettings& settings);

/// Throws Error: suspicious-unit for a position farther from the effector than a hundred sizes of
/// the robot: usually millimetres mistaken for metres.
/// @param simulation,effector of the target. @param target to be checked.
void check_target(const sim::Simulation& simulation, int effector, const Target& target);

}  // namespace sinew::control
