/// @file
/// Fits the parameters of a constant-curvature arm to motion capture of the ends of its segments.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sinew/identify/arm_motion.hpp"
#include "sinew/identify/parameter_fit.hpp"

namespace sinew::identify {

/// How the angles and rates at the start of records are determined.
enum class RecordStart {
  at_rest,  ///< angles fitted, rates zero: held, then released
  moving,   ///< both fitted
};

/// Bounds and options of fit_arm().
struct ArmFitSettings {
  double mass_spread = 0.38;       ///< bounds of the masses: 1 -+ this, times the arm's own
  double stiffness_spread = 0.23;  ///< likewise for the stiffness
  double damping_lower = 1e-3, damping_upper = 5e-3;  ///< N m s, of the first coordinate
  double coefficient_spread = 0.9;                    ///< likewise for c of the actuators
  double delay_upper = 0.5;                           ///< s, bound of their common delay
  std::vector<std::string> fixed;  ///< names of known parameters, such as weighed masses
  RecordStart start = RecordStart::at_rest;
  pcc::ArmStepSettings step{.time_step = 5e-3};
  ParameterFitSettings search;
};

/// Prediction and errors of one record.
struct RecordFit {
  std::string name;
  ArmStart start;
  MatrixX predicted;                ///< (samples, 3 segments) m
  double nrmse = 0.0;               ///< over all measured ends and axes
  double mean_error = 0.0;          ///< m, mean distance of the ends seen, wholly or in part
  double summed_error = 0.0;        ///< m, sum of these distances over samples and segments
  double start_summed_error = 0.0;  ///< m, the same before the fit
};

/// A fitted arm.
struct ArmFit {
  ParameterFit fit;  ///< "mass_0", ..., "stiffness", "damping", "coefficient_0", ..., "delay"; then
                     ///< each record's "RECORD.angle_0", ..., "RECORD.rate_0", ...
  Eigen::Index own = 0;  ///< parameters of the arm, before those of the records
  ArmModel model;
  std::vector<RecordFit> records;  ///< as given

  /// Number of undetermined directions that involve the arm's own parameters. With lumped masses,
  /// the fast motion at the start of a record decays within a frame; and if a first marker was not
  /// seen, its direction is lost. Neither harms another parameter.
  int undetermined() const;
};

/// Fits the parameters of an arm: N masses, the stiffness k_1 and damping b of the first coordinate
/// (those of the others keep their ratios to it), and, with actuators, a coefficient c each and one
/// delay. These are 2N + 3 parameters if every segment has an actuator, 2N + 2 if the first has
/// none, and N + 2 for a passive arm (Marchese, Tedrake & Rus, Int. J. Robotics Research 35, 2016).
/// The start of each record is fitted as well. The search starts from the arm's own parameters;
/// derivatives are exact. If only motion is observed and volumes drive it, a common factor of
/// masses, stiffness, damping and coefficients is undetermined: ParameterFit::directions reports
/// it, and one of them must be fixed. Known torques leave no such freedom.
/// @param model initial guess. @param records to fit to; their inputs are volumes with actuators,
///   torques without. @param settings bounds and search.
/// Throws Error: empty-list (no records), wrong-length (segments or inputs), unknown-name (fixed),
/// out-of-range (a spread that reaches zero, a stiffness or damping of zero), too-few-points
/// (records shorter than the model's order), and what check() and fit_parameters() throw.
ArmFit fit_arm(const ArmModel& model, std::span<const MotionRecord> records,
               const ArmFitSettings& settings = {});

/// Evaluates a model on records to which it was not fitted, each from its first pose at rest.
/// @param model fitted. @param records for validation. @param step of the simulation.
std::vector<RecordFit> validate_arm(const ArmModel& model, std::span<const MotionRecord> records,
                                    const pcc::ArmStepSettings& step);

}  // namespace sinew::identify
