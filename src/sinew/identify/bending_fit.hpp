/// @file
/// Fits the modulus of a bending actuator to motions of its tip, by bounded least squares.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "sinew/identify/tip_record.hpp"
#include "sinew/pcc/bending_motion.hpp"

namespace sinew::identify {

/// Distance between two tips over a record.
struct TipErrors {
  double mean = 0.0;            ///< m, mean distance
  double largest = 0.0;         ///< m
  double mean_of_length = 0.0;  ///< mean over the actuator's length
  double largest_of_length = 0.0;
  std::array<double, 2> mean_absolute{};     ///< MAE of x and y, m
  std::array<double, 2> root_mean_square{};  ///< RMSE of x and y, m
};

/// Computes the errors of a tip. @param found,measured (n, 2) m. @param length m. Throws Error:
/// wrong-length, out-of-range.
TipErrors tip_errors(const PlanePoints& found, const PlanePoints& measured, double length);

/// What fit_bending() fits, and how.
struct BendingFitSettings {
  /// Degree of E(P), 0 to 5; 0 is a constant. The polynomial is fitted by its values at degree + 1
  /// Chebyshev points of the records' pressures, to which bounds apply separately.
  int degree = 0;
  pcc::ModulusKind kind = pcc::ModulusKind::bending;
  double lowest = 1e3, highest = 1e9;  ///< Pa, bounds of those values
  bool damping = false;                ///< fit Rayleigh's beta as well
  double highest_damping = 1.0;        ///< s
  double longest_step = 5e-3;          ///< s
  pcc::BendingMotionSettings motion;
};

/// A fitted actuator.
struct BendingFit {
  pcc::BendingParameters parameters;  ///< those given, with the fitted ones replaced
  std::vector<PlanePoints> tips;      ///< simulated tip of each record
  std::vector<TipErrors> errors;      ///< of each record
  double cost = 0.0;  ///< mean squared distance over squared length, equal weight per record
  bool converged = false;
  bool at_bound = false;  ///< a value is at its bound, which then determines it
};

/// Minimises the sum over records of the mean squared distance between the measured and the
/// simulated tip. Every record starts at rest, in the equilibrium of its first pressure. Uses a
/// trust region with bounds (Ceres), starting from the modulus of `parameters` at the mean
/// pressure, clamped into the bounds. The fitted polynomial is only valid for the records'
/// pressures.
/// @param parameters everything that is not fitted.
/// @param records each with pressures.
/// @param settings what to fit, and how.
/// Throws Error: empty-list (no records), missing-key (a record without pressures), out-of-range,
/// contradictory-limits (settings), not-converged if no start can be simulated, and what check() of
/// records and of parameters throws.
BendingFit fit_bending(const pcc::BendingParameters& parameters, std::span<const TipRecord> records,
                       const BendingFitSettings& settings = {});

}  // namespace sinew::identify
