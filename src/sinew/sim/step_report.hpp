/// @file
/// What is told of a step.
#pragma once

#include "sinew/sim/newton_status.hpp"
#include "sinew/sim/stages.hpp"
#include "sinew/sim/step_status.hpp"
#include "sinew/step/law_status.hpp"

namespace sinew::sim {

using step::LawStatus;

/// What a step did.
struct StepReport {
  StepStatus status = StepStatus::solved;
  LawStatus law = LawStatus::solved;
  double residual = 0.0;           ///< N, |p - f - ... + H^T lambda| at the end of the step
  double relative_residual = 0.0;  ///< of the sum of the forces' norms
  double violation = 0.0;          ///< m, of the law by the motion at the end
  int iterations = 1;              ///< linear solutions, of the last substep
  int substeps = 1;                ///< that the step was made of
  int retries = 0;                 ///< substeps that were taken back and tried smaller
  int impacts = 0;                 ///< moments at which event-driven integration solved an impact
  double error = 0.0;              ///< m, largest estimate of a substep's error in any coordinate
  double scale = 1.0;  ///< of the motion; < 1 when it was cut back to keep elements from inverting
  double energy_gained = 0.0;  ///< J, since the start: energy beyond what was put in, if > 0
  double smallest_volume_ratio = 1.0;  ///< min det F at the end of the step
  /// How far contact forces are from their laws, see qp::ConeResult; 0 without contacts.
  double contact_residual = 0.0;         ///< relative, of all laws
  double contact_signorini = 0.0;        ///< m
  double contact_coulomb = 0.0;          ///< m
  double contact_complementarity = 0.0;  ///< J, of gap times normal force
  /// Of aggregated contacts: about how far their forces are from those of single points, relative
  /// to the sum of the zones' forces, see ContactZones::end_step(); 0 without zones.
  double contact_aggregation = 0.0;
  /// Whether a controller's choice did not settle and was held as it was: another one, that serves
  /// about as well, may have been found from other rounding.
  bool choice_held = false;
  int contact_sweeps = 0;  ///< of Gauss-Seidel, in the last solution of the law
  NewtonStatus newton = NewtonStatus::converged;
  StageTimes times;
};

}  // namespace sinew::sim
