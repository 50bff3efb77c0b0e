/// @file
/// What an inverse controller is asked, and how it works.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "sinew/inverse/contact_task.hpp"
#include "sinew/inverse/target.hpp"

namespace sinew::sim {
class Simulation;
}

namespace sinew::inverse {

/// Which efforts are preferred among those that serve the targets equally well.
enum class Regularisation {
  change,  ///< those of the step before: no bias of the effector at rest
  effort,  ///< zero efforts, as published: biases the effector by about epsilon
};

/// What is asked of one effector.
struct EffectorTask {
  int effector = 0;
  Target target;
  /// One for all rows of the effector, or one each; >= 0. Squared distances are multiplied by it.
  std::vector<double> weights = {1.0};
  /// 1 comes first. Squared distances of each later one weigh kLaterPriority of those before: what
  /// it lacks moves a target of the one before by about that part of it, times how much farther it
  /// moves than that.
  int priority = 1;

  static constexpr double kLaterPriority = 1e-4;

  /// Of a row of the effector, within its priority.
  double weight(Eigen::Index row) const {
    return weights[weights.size() == 1 ? 0 : static_cast<std::size_t>(row)];
  }
  /// Of a row among those of all tasks.
  double weight_by_priority(Eigen::Index row) const {
    return weight(row) * std::pow(kLaterPriority, priority - 1);
  }
};

/// What a ClosedLoop goes by.
struct Feedback {
  std::vector<int> sensors;  ///< (tasks,) of Model::sensors(): which measures each task's effector
  double gain = 5.0;         ///< 1/s, > 0: an error without delay falls as exp(-gain t)
  double integral = 0.0;     ///< 1/s^2, >= 0: of the time integral of the error
  /// s, > 0: all commands are held while a sample is older than its sensor's delay and this.
  double timeout = 0.1;
};

struct InverseSettings {
  std::vector<EffectorTask> tasks;
  std::vector<ContactTask> contacts;
  std::vector<int> actuators;  ///< that the controller owns; empty: all
  Regularisation regularisation = Regularisation::change;
  /// eps = epsilon |W_ea^T Q W_ea|_inf / |W_aa|_inf weighs the regularisation (Coevoet, Escande and
  /// Duriez, IEEE RA-L 2(3), 2017, section III-C, with 1e-3 and Regularisation::effort).
  double epsilon = 1e-3;
  /// With Regularisation::change: share of it that still draws efforts to zero, so that cables that
  /// pull against each other let go in time.
  double relaxation = 1e-2;
  /// A target farther away than this part of the robot's size is approached by steps of that
  /// length, since beyond it the linearisation is worth nothing; a rotation by as many rad a step.
  double largest_step = 0.02;
  /// m (or rad): an effector this near to its target is on target.
  double tolerance = 1e-4;
  /// Whether every choice gets a certificate, which takes longer than the choice.
  bool certify = false;
  /// None: the simulated effectors are where they are known to be. A closed loop uses tasks,
  /// actuators and tolerance alone of all else.
  std::optional<Feedback> feedback = {};
};

/// Names all actuators that a controller may own where the settings name none, and checks the rest.
/// Throws Error: no-effectors (and no contacts), no-actuators, wrong-actuator-type, wrong-length
/// (weights), out-of-range, duplicate-key (a contact twice), suspicious-unit.
void check_settings(const sim::Simulation& simulation, InverseSettings& settings);

/// Throws Error(suspicious-unit) for a position farther from the effector than a hundred sizes of
/// the robot: as a rule millimetres that were taken for metres.
void check_target(const sim::Simulation& simulation, int effector, const Target& target);

}  // namespace sinew::inverse
