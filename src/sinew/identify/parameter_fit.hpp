/// @file
/// Named parameters of any simulation from measurements, by bounded least squares, with what the
/// data say about each: intervals, and directions that they do not determine.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::identify {

struct Parameter {
  std::string name;
  double start = 0.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::string unit;    ///< for messages and tables
  bool fixed = false;  ///< known, for instance by weighing
  double scale = 0.0;  ///< a typical size; 0: |start|, else the bounds' distance, else 1
};

/// What a simulation predicts.
struct ForwardModel {
  Eigen::Index observations = 0;
  /// Fills prediction (observations,) and, unless null, its derivative (observations, parameters).
  /// May throw Error: a failed run (diverged, not-converged) rejects these parameters, anything
  /// else ends the fit.
  std::function<void(const VectorX& parameters, VectorX& prediction, MatrixX* jacobian)> predict;
};

/// A model without derivatives: central differences of `step` times each parameter's scale.
/// @param observations how many. @param predict parameters -> (observations,).
/// @param scales (parameters,) typical sizes; 0 for those fixed. @param step relative; truncation
/// goes with its square, the run's rounding and iteration errors with its inverse.
ForwardModel with_differences(Eigen::Index observations,
                              std::function<VectorX(const VectorX&)> predict, VectorX scales,
                              double step = 1e-5);

struct ParameterFitSettings {
  int starts = 1;  ///< the first as given, others at random between the bounds
  std::uint64_t seed = 1;
  double confidence = 0.95;  ///< of the intervals, 0 to 1
  int max_iterations = 100;
  double tolerance = 1e-10;  ///< relative, of cost and parameters
};

struct FittedParameter {
  std::string name, unit;
  double value = 0.0;
  double lower = 0.0, upper = 0.0;  ///< its bounds
  bool fixed = false;
  bool at_bound = false;                              ///< the bound decides it; it has no interval
  double standard_error = 0.0;                        ///< infinite where undetermined; 0 if fixed
  double interval_lower = 0.0, interval_upper = 0.0;  ///< of the confidence asked for
  bool determined = true;  ///< no undetermined direction has a part in it
};

/// A combination of parameters that changes the prediction least: relative changes of those that
/// are positive, changes by their scale of the others.
struct Direction {
  double singular_value = 0.0;  ///< of the Jacobian so scaled, in the unit of the observations
  double relative_error = 0.0;  ///< standard error along it: noise over singular value
  bool undetermined = false;    ///< the singular value vanishes, or the error exceeds 1
  VectorX weights;              ///< (parameters,) of length 1; 0 for those fixed or at bounds
};

/// A weight in a direction that counts.
inline constexpr double kPartOfDirection = 1e-3;

struct ParameterFit {
  std::vector<FittedParameter> parameters;
  VectorX values;                     ///< (parameters,)
  std::vector<Direction> directions;  ///< from the best determined to the worst
  MatrixX covariance;  ///< (parameters, parameters); 0 for those fixed, at bounds or undetermined
  VectorX prediction;  ///< (observations,)
  VectorX residual;    ///< prediction - measured; NaN where nothing was measured
  double start_cost = 0.0;  ///< sum of squares at the given start
  double cost = 0.0;        ///< sum of squared residuals
  double noise = 0.0;       ///< standard deviation of the residuals
  int degrees_of_freedom = 0;
  std::vector<double> costs;  ///< of each start; infinite for those that failed
  int best_start = 0, iterations = 0;
  bool converged = false;

  int undetermined() const;  ///< directions
  /// Throws Error(unknown-name) for a name that there is not.
  const FittedParameter& parameter(const std::string& name) const;
};

/// Minimises |prediction - measured|^2 within bounds: trust region (Ceres). Intervals are those of
/// the linearised problem with Student's t, value -+ t s sqrt((J^T J)^-1_ii) (Seber & Wild,
/// Nonlinear Regression, 1989, sec. 5.1): they hold for independent noise of one size and a model
/// that is right. Parameters at bounds are left out of it. Directions come from the singular values
/// of the scaled Jacobian at the solution; where one is undetermined, the solution along it is
/// where the start or a bound left it, and parameters with a part in it have no interval.
/// @param model what predicts. @param measured (observations,); NaN: nothing measured there.
/// @param parameters at least one that is not fixed. @param settings how.
/// Throws Error: empty-list, wrong-length, contradictory-limits, out-of-range, not-finite,
/// too-few-points (fewer measurements than parameters), not-converged when no start can be run,
/// and what the model throws.
ParameterFit fit_parameters(const ForwardModel& model, const VectorX& measured,
                            const std::vector<Parameter>& parameters,
                            const ParameterFitSettings& settings = {});

/// A table of the parameters with their intervals, and of what is not determined.
/// @param fit to tell of. @param count parameters, from the first; -1: all.
std::string fit_table(const ParameterFit& fit, Eigen::Index count = -1);

}  // namespace sinew::identify
