/// @file
/// The report of a step.
#pragma once

#include <limits>

#include "sinew/law/law_status.hpp"
#include "sinew/run/newton_status.hpp"
#include "sinew/run/step_status.hpp"
#include "sinew/world/stages.hpp"

namespace sinew::run {

using law::LawStatus;

/// How a step was solved, and how accurately.
struct StepReport {
  StepStatus status = StepStatus::solved;
  LawStatus law = LawStatus::solved;
  bool balanced = true;   ///< whether forces balance at the end; more severe statuses hide this
  bool physical = true;   ///< whether a robot can have this state, see Sanity
  double residual = 0.0;  ///< N, |p - f - ... + H^T lambda| at the end of the step
  double relative_residual = 0.0;  ///< relative to the sum of the forces' norms
  double violation = 0.0;          ///< m, violation of the law by the motion at the end
  /// m, bound of the distance (largest difference of any coordinate) between the state and the
  /// solution of the step's equation under the same commands, see distance_bound(). Infinite if no
  /// bound was found; NaN if none was sought: in dynamic steps that took less than two iterations,
  /// and in flagged steps.
  double distance = std::numeric_limits<double>::quiet_NaN();
  bool following = false;  ///< whether the step could end as Equilibrium::following
  int iterations = 1;      ///< linear solutions in the last substep
  int substeps = 1;        ///< number of substeps
  /// Substeps that were undone and retried, smaller or with a smaller change of the efforts that a
  /// controller chooses.
  int retries = 0;
  int impacts = 0;     ///< impact times solved by event-driven integration
  double error = 0.0;  ///< m, largest error estimate of a substep in any coordinate
  double scale = 1.0;  ///< factor of the motion; < 1 if reduced to keep elements from inverting
  double energy_gained = 0.0;  ///< J, energy since the start in excess of the work done, if > 0
  double smallest_volume_ratio = 1.0;  ///< min det F at the end of the step
  /// Residuals of the contact laws, see qp::ConeResult; 0 without contacts.
  double contact_residual = 0.0;         ///< relative, of all contact laws
  double contact_signorini = 0.0;        ///< m
  double contact_coulomb = 0.0;          ///< m
  double contact_complementarity = 0.0;  ///< J, gap times normal force
  /// Approximate difference between the forces of aggregated contacts and those of single points,
  /// relative to the sum of the zones' forces, see ContactZones::end_step(); 0 without zones.
  double contact_aggregation = 0.0;
  /// Whether a controller's choice did not settle and was frozen. With different rounding, another
  /// choice of about the same quality may have been found.
  bool choice_held = false;
  /// Whether a quasi-static step left the branch of equilibria on which it began, as where an arch
  /// snaps through or a column buckles: its solution needed the descent with the projected tangent,
  /// or Newton's method went far beyond its first motion through unstable states. No flag.
  bool snapped = false;
  int contact_sweeps = 0;  ///< Gauss-Seidel sweeps in the last solution of the law
  NewtonStatus newton = NewtonStatus::converged;
  world::StageTimes times;
};

}  // namespace sinew::run
