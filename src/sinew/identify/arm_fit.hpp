/// @file
/// The parameters of a constant-curvature arm from motion capture of its segments' ends.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sinew/identify/arm_motion.hpp"
#include "sinew/identify/parameter_fit.hpp"

namespace sinew::identify {

/// Angles and rates at which records start.
enum class RecordStart {
  at_rest,  ///< angles fitted, rates zero: held, then let go
  moving,   ///< both fitted
};

struct ArmFitSettings {
  double mass_spread = 0.38;       ///< bounds of the masses: 1 -+ this times the arm's own
  double stiffness_spread = 0.23;  ///< of the stiffness, likewise
  double damping_lower = 1e-3, damping_upper = 5e-3;  ///< N m s, of the first coordinate
  double coefficient_spread = 0.9;                    ///< of the actuators' c, likewise
  double delay_upper = 0.5;                           ///< s, of their common delay
  std::vector<std::string> fixed;  ///< names of parameters that are known, as by weighing
  RecordStart start = RecordStart::at_rest;
  pcc::ArmStepSettings step{.time_step = 5e-3};
  ParameterFitSettings search;
};

/// How a record is met.
struct RecordFit {
  std::string name;
  ArmStart start;
  MatrixX predicted;                ///< (samples, 3 segments) m
  double nrmse = 0.0;               ///< over all ends and axes that move
  double mean_error = 0.0;          ///< m, mean distance of an end that was seen wholly or in part
  double summed_error = 0.0;        ///< m, sum of these over samples and segments
  double start_summed_error = 0.0;  ///< m, of the parameters before the fit
};

struct ArmFit {
  ParameterFit fit;  ///< "mass_0", ..., "stiffness", "damping", "coefficient_0", ..., "delay"; then
                     ///< each record's "RECORD.angle_0", ..., "RECORD.rate_0", ...
  Eigen::Index own = 0;  ///< parameters of the arm, before those of the records
  ArmModel model;
  std::vector<RecordFit> records;  ///< as given

  /// Directions that are not determined and have a part in the arm's own parameters. Fast motion of
  /// a record's start dies within a frame where masses are lumped, and where a first marker was not
  /// seen its direction is lost; that harms no other parameter.
  int undetermined() const;
};

/// Fits N masses, the first coordinate's stiffness k_1 and damping b (those of the others keep
/// their ratios to it), and with actuators a coefficient c each and one delay: 2N + 2 parameters
/// where the first segment has no actuator, N + 2 of a passive arm (Marchese, Tedrake & Rus, Int.
/// J. Robotics Research 35, 2016). The start of each record is fitted as well. The arm's own
/// parameters are where the search starts; derivatives are exact. When motion alone is observed and
/// volumes drive it, masses, stiffness, damping and coefficients may all be multiplied by one
/// number: ParameterFit::directions tells so, and one of them must be fixed. Torques that are known
/// leave no such freedom.
/// @param model where to start. @param records to fit to; their inputs are volumes with actuators,
/// torques without. @param settings bounds and search.
/// Throws Error: empty-list (no records), wrong-length (segments or inputs), unknown-name (fixed),
/// out-of-range (a spread that reaches zero, a stiffness or damping of zero), too-few-points
/// (records shorter than the model's order), and what check() and fit_parameters() do.
ArmFit fit_arm(const ArmModel& model, std::span<const MotionRecord> records,
               const ArmFitSettings& settings = {});

/// How a model meets records that it was not fitted to, each from its first pose at rest.
/// @param model as fitted. @param records others. @param step of the simulation.
std::vector<RecordFit> validate_arm(const ArmModel& model, std::span<const MotionRecord> records,
                                    const pcc::ArmStepSettings& step);

}  // namespace sinew::identify
