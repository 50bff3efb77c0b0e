/// @file
/// Settings of an inverse controller: its tasks and how it works.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "sinew/control/contact_task.hpp"
#include "sinew/control/target.hpp"

namespace sinew::sim {
class Simulation;
}

namespace sinew::control {

/// The preference among efforts that serve the targets equally well.
enum class Regularisation {
  change,  ///< near the efforts of the previous step: no bias of the effector at rest
  effort,  ///< near zero effort, as published: biases the effector by about epsilon
};

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

/// Feedback settings of a ClosedLoop.
struct Feedback {
  std::vector<int> sensors;  ///< (tasks,) indices in sense::sensors_of(): that of each effector
  double gain = 5.0;         ///< 1/s, > 0: without delay, an error decays as exp(-gain t)
  double integral = 0.0;     ///< 1/s^2, >= 0: gain of the time integral of the error
  /// s, > 0: all commands are held while a sample is older than its sensor's delay plus this.
  double timeout = 0.1;
};

/// Tasks, actuators and options of a controller.
struct InverseSettings {
  std::vector<EffectorTask> tasks;
  std::vector<ContactTask> contacts;
  std::vector<int> actuators;  ///< owned by the controller; empty: all
  Regularisation regularisation = Regularisation::change;
  /// Weight of the regularisation: eps = epsilon |W_ea^T Q W_ea|_inf / |W_aa|_inf (Coevoet, Escande
  /// and Duriez, IEEE RA-L 2(3), 2017, section III-C, with 1e-3 and Regularisation::effort).
  double epsilon = 1e-3;
  /// With Regularisation::change: the fraction of it that still draws efforts to zero, so that
  /// cables that pull against each other relax in time.
  double relaxation = 1e-2;
  /// A target farther away than this, relative to the robot's size, is approached in steps of that
  /// length, since the linearisation does not hold beyond; a rotation, in steps of as many rad.
  double largest_step = 0.02;
  /// m (or rad): an effector within this distance of its target is on target.
  double tolerance = 1e-4;
  /// Whether every choice gets a certificate, which takes longer than the choice itself.
  bool certify = false;
  /// Without feedback, the controller uses the simulated positions of the effectors. A closed loop
  /// uses only tasks, actuators and tolerance of the other settings.
  std::optional<Feedback> feedback = {};
};

/// Checks the settings; if they name no actuators, selects all that a controller may own.
/// Throws Error: no-effectors (and no contacts), no-actuators, wrong-actuator-type, wrong-length
/// (weights), out-of-range, duplicate-key (a contact twice), suspicious-unit.
void check_settings(const sim::Simulation& simulation, InverseSettings& settings);

/// Throws Error: suspicious-unit for a position farther from the effector than a hundred sizes of
/// the robot: usually millimetres mistaken for metres.
void check_target(const sim::Simulation& simulation, int effector, const Target& target);

}  // namespace sinew::control
