/// @file
/// Fits named parameters of any simulation to measurements, by bounded least squares, with
/// confidence intervals and the directions that the data do not determine.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::identify {

/// A parameter to be fitted, with bounds.
struct Parameter {
  std::string name;
  double start = 0.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::string unit;    ///< for messages and tables
  bool fixed = false;  ///< known, for example from weighing
  double scale = 0.0;  ///< typical size; 0: |start|, else the range of the bounds, else 1
};

/// A simulation as a function of parameters.
struct ForwardModel {
  Eigen::Index observations = 0;
  /// Fills prediction (observations,) and, unless null, its derivative (observations, parameters).
  /// May throw Error: a failed run (diverged, not-converged) rejects the parameters; any other
  /// error ends the fit.
  std::function<void(const VectorX& parameters, VectorX& prediction, MatrixX* jacobian)> predict;
};

/// Makes a model with derivatives by central differences of `step` times each parameter's scale.
/// @param observations their number. @param predict parameters -> (observations,).
/// @param scales (parameters,) typical sizes; 0 for fixed ones.
/// @param step relative; the truncation error grows with its square, rounding and iteration errors
///   of the run with its inverse.
ForwardModel with_differences(Eigen::Index observations,
                              std::function<VectorX(const VectorX&)> predict, VectorX scales,
                              double step = 1e-5);

/// How far a fit has come.
struct FitProgress {
  int evaluations = 0;  ///< predictions with or without derivatives
  double cost = 0.0;    ///< lowest sum of squared residuals so far
  VectorX values;       ///< (parameters,) where it was found
};

/// Options of fit_parameters().
struct ParameterFitSettings {
  int starts = 1;  ///< the first as given, others random within the bounds
  std::uint64_t seed = 1;
  double confidence = 0.95;  ///< of the intervals, 0 to 1
  int max_iterations = 100;
  double tolerance = 1e-10;  ///< relative, of cost and parameters
  /// Called after every prediction; false ends the fit at the best parameters so far.
  std::function<bool(const FitProgress&)> proceed;
};

/// A fitted parameter and its confidence interval.
struct FittedParameter {
  std::string name, unit;
  double value = 0.0;
  double lower = 0.0, upper = 0.0;  ///< its bounds
  bool fixed = false;
  bool at_bound = false;        ///< determined by its bound; it has no interval
  double standard_error = 0.0;  ///< infinite if undetermined; 0 if fixed
  double interval_lower = 0.0, interval_upper = 0.0;  ///< at the requested confidence
  bool determined = true;                             ///< no undetermined direction involves it
};

/// A direction in parameter space: relative changes of positive parameters, changes in units of the
/// scale of the others.
struct Direction {
  double singular_value = 0.0;  ///< of the Jacobian so scaled, unit of the observations
  double relative_error = 0.0;  ///< standard error along it: noise over singular value
  bool undetermined = false;    ///< the singular value vanishes, or the error exceeds 1
  VectorX weights;              ///< (parameters,) of length 1; 0 for those fixed or at bounds
};

/// The smallest weight with which a direction involves a parameter.
inline constexpr double kPartOfDirection = 1e-3;

/// Fitted parameters and what the data determine.
struct ParameterFit {
  std::vector<FittedParameter> parameters;
  VectorX values;                     ///< (parameters,)
  std::vector<Direction> directions;  ///< from the best to the worst determined
  MatrixX covariance;  ///< (parameters, parameters); 0 for those fixed, at bounds or undetermined
  VectorX prediction;  ///< (observations,)
  VectorX residual;    ///< prediction - measured; NaN where nothing was measured
  double start_cost = 0.0;  ///< sum of squares at the given start
  double cost = 0.0;        ///< sum of squared residuals
  double noise = 0.0;       ///< standard deviation of the residuals
  int degrees_of_freedom = 0;
  std::vector<double> costs;  ///< of each start; infinite if it failed
  int best_start = 0, iterations = 0;
  bool converged = false;
  bool stopped = false;  ///< by ParameterFitSettings::proceed

  int undetermined() const;  ///< number of undetermined directions
  /// A parameter by name. Throws Error: unknown-name.
  const FittedParameter& parameter(const std::string& name) const;
};

/// Minimises |prediction - measured|^2 within bounds by a trust region method (Ceres). Intervals
/// are those of the linearised problem with Student's t, value -+ t s sqrt((J^T J)^-1_ii) (Seber &
/// Wild, Nonlinear Regression, 1989, sec. 5.1). They hold for independent noise of equal variance
/// and a correct model. Parameters at bounds are excluded from it. Directions come from the
/// singular values of the scaled Jacobian at the solution. Along an undetermined direction, the
/// solution is where the start or a bound left it, and parameters that the direction involves have
/// no interval.
/// @param model to be fitted. @param measured (observations,); NaN: not measured.
/// @param parameters at least one that is not fixed. @param settings options.
/// Throws Error: empty-list, wrong-length, contradictory-limits, out-of-range, not-finite,
/// too-few-points (fewer measurements than parameters), not-converged if no start can be simulated,
/// and what the model throws.
ParameterFit fit_parameters(const ForwardModel& model, const VectorX& measured,
                            const std::vector<Parameter>& parameters,
                            const ParameterFitSettings& settings = {});

/// A table of the parameters with their intervals, and of the undetermined directions.
/// @param fit to print. @param count parameters, from the first; -1: all.
std::string fit_table(const ParameterFit& fit, Eigen::Index count = -1);

}  // namespace sinew::identify
