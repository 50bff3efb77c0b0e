/// @file
/// Settings of an inverse controller, besides those of all controllers: how it chooses efforts.
#pragma once

#include <vector>

#include "sinew/control/contact_task.hpp"
#include "sinew/control/target_settings.hpp"

namespace sinew::model {
class Model;
}

namespace sinew::control {

/// The preference among efforts that serve the targets equally well.
enum class Regularisation {
  change,  ///< near the efforts of the previous step: no bias of the effector at rest
  effort,  ///< near zero effort, as published: biases the effector by about epsilon
};

/// Contacts whose forces an inverse controller keeps, and its options.
struct InverseSettings {
  std::vector<ContactTask> contacts;
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
  /// Whether every choice gets a certificate, which takes longer than the choice itself.
  bool certify = false;
};

/// Checks all settings but those that check_settings(simulation, targets) checks.
/// Throws Error: no-effectors (and no contacts), out-of-range, duplicate-key (a contact twice).
/// @param model to be steered. @param targets,settings of an inverse controller.
void check_settings(const model::Model& model, const TargetSettings& targets,
                    const InverseSettings& settings);

}  // namespace sinew::control
