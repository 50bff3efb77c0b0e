#include "sinew/identify/parameter_fit.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/random.hpp"
#include "sinew/core/types.hpp"
#include "sinew/identify/bounded_least_squares.hpp"
#include "sinew/identify/refuse.hpp"
#include "sinew/identify/statistics.hpp"
#include "sinew/linalg/dense.hpp"

namespace sinew::identify {

namespace {

/// Relative to the largest singular value: smaller ones are rounding.
constexpr double kVanishing = 1e-7;

double scale_of(const Parameter& p) {
  if (p.scale > 0.0) return p.scale;
  if (p.start != 0.0) return std::abs(p.start);
  return std::isfinite(p.upper - p.lower) && p.upper > p.lower ? p.upper - p.lower : 1.0;
}

void check(const ForwardModel& model, const VectorX& measured,
           const std::vector<Parameter>& parameters, const ParameterFitSettings& settings) {
  if (parameters.empty() || std::ranges::all_of(parameters, &Parameter::fixed)) {
    refuse(ErrorKind::empty_list, "parameters", "there is nothing to fit",
           "give a parameter that is not fixed");
  }
  for (const Parameter& p : parameters) {
    if (!std::isfinite(p.start) || std::isnan(p.lower) || std::isnan(p.upper)) {
      refuse(ErrorKind::not_finite, p.name, "its start or a bound is not a number", "give numbers");
    }
    if (p.lower > p.upper) {
      refuse(ErrorKind::contradictory_limits, p.name,
             fmt::format("its bounds are {:g} to {:g}", p.lower, p.upper), "give lower <= upper");
    }
    if (!p.fixed && (p.start < p.lower || p.start > p.upper)) {
      refuse(ErrorKind::out_of_range, p.name,
             fmt::format("it starts at {:g}, outside its bounds {:g} to {:g}", p.start, p.lower,
                         p.upper),
             "start within the bounds");
    }
  }
  if (settings.starts < 1) {
    refuse(ErrorKind::out_of_range, "starts", fmt::format("there are {} starts", settings.starts),
           "give one or more");
  }
  if (!(settings.confidence > 0.0 && settings.confidence < 1.0)) {
    refuse(ErrorKind::out_of_range, "confidence",
           fmt::format("the confidence is {:g}", settings.confidence), "give for instance 0.95");
  }
  if (measured.size() != model.observations) {
    refuse(ErrorKind::wrong_length, "measured",
           fmt::format("{} measurements, {} predictions", measured.size(), model.observations),
           "give one for each; nan where nothing was measured");
  }
  if (measured.array().isInf().any()) {
    refuse(ErrorKind::not_finite, "measured", "a measurement is infinite",
           "give numbers; nan where nothing was measured");
  }
}

/// The problem in scaled units, restricted to free parameters and measured observations.
struct Problem {
  const ForwardModel& model;
  const VectorX& measured;
  const std::vector<Parameter>& parameters;
  std::vector<Eigen::Index> free, seen;
  VectorX scale;
  // The free parameters that a solve moves, and the values of all others.
  std::vector<Eigen::Index> moving;
  VectorX base;
  mutable VectorX prediction;
  mutable MatrixX jacobian;
  mutable std::exception_ptr failure;
  std::function<bool(const FitProgress&)> proceed;
  mutable FitProgress progress{.evaluations = 0, .cost = kInfinity, .values = {}};
  mutable bool stopped = false;

  Problem(const ForwardModel& model_, const VectorX& measured_,
          const std::vector<Parameter>& parameters_)
      : model(model_), measured(measured_), parameters(parameters_) {
    scale.resize(static_cast<Eigen::Index>(parameters.size()));
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      scale[static_cast<Eigen::Index>(k)] = scale_of(parameters[k]);
      if (!parameters[k].fixed) free.push_back(static_cast<Eigen::Index>(k));
    }
    for (Eigen::Index i = 0; i < measured.size(); ++i) {
      if (!std::isnan(measured[i])) seen.push_back(i);
    }
  }

  const Parameter& parameter(Eigen::Index k) const {
    return parameters[static_cast<std::size_t>(k)];
  }
  VectorX starts() const {
    VectorX result(scale.size());
    for (Eigen::Index k = 0; k < result.size(); ++k) {
      result[k] = parameters[static_cast<std::size_t>(k)].start;
    }
    return result;
  }
  VectorX values(const double* x) const {
    VectorX result = base;
    for (std::size_t j = 0; j < moving.size(); ++j) {
      const Eigen::Index k = moving[j];
      // Enforces the bounds in the parameters' own units, whatever scaling rounds.
      result[k] = std::clamp(scale[k] * x[j], parameter(k).lower, parameter(k).upper);
    }
    return result;
  }
  /// Returns false if the run failed.
  bool evaluate(const VectorX& values, bool derivatives) const {
    prediction.resize(model.observations);
    if (derivatives) jacobian.resize(model.observations, values.size());
    try {
      model.predict(values, prediction, derivatives ? &jacobian : nullptr);
    } catch (const Error& error) {
      if (!error.is_run_failure()) throw;
      return false;
    }
    return std::ranges::all_of(seen, [&](Eigen::Index i) { return std::isfinite(prediction[i]); });
  }
  /// Residuals of the moving parameters, for the solver. No exception passes through the solver;
  /// fit_parameters() rethrows it.
  bool residuals(const double* x, double* result, double* derivatives) const {
    if (failure || stopped) return false;
    try {
      const VectorX at = values(x);
      const bool good = evaluate(at, derivatives != nullptr);
      note(at, good);
      if (!good) return false;
    } catch (...) {
      failure = std::current_exception();
      return false;
    }
    for (std::size_t r = 0; r < seen.size(); ++r) {
      result[r] = prediction[seen[r]] - measured[seen[r]];
      if (derivatives == nullptr) continue;
      for (const Eigen::Index k : moving) *derivatives++ = jacobian(seen[r], k) * scale[k];
    }
    return true;
  }
  /// Keeps the best parameters, and asks whether to go on.
  void note(const VectorX& at, bool good) const {
    ++progress.evaluations;
    if (const double now = good ? cost() : kInfinity; now < progress.cost) {
      progress.cost = now;
      progress.values = at;
    }
    if (proceed && !proceed(progress)) stopped = true;
  }
  double cost() const {
    double sum = 0.0;
    for (const Eigen::Index i : seen) sum += std::pow(prediction[i] - measured[i], 2);
    return sum;
  }
};

struct Descent {
  VectorX values;
  double cost = kInfinity;
  int iterations = 0;
  bool converged = false;
};

/// Minimises over the moving parameters within bounds.
BoundedResult descend(Problem& problem, const ParameterFitSettings& settings, int iterations) {
  std::vector<BoundedValue> values;
  for (const Eigen::Index k : problem.moving) {
    const double scale = problem.scale[k], lower = problem.parameter(k).lower / scale,
                 upper = problem.parameter(k).upper / scale;
    values.push_back({std::clamp(problem.base[k] / scale, lower, upper), lower, upper});
  }
  const auto residuals = [&](const double* x, double* result, double* derivatives) {
    return problem.residuals(x, result, derivatives);
  };
  const BoundedResult result = solve_bounded(residuals, problem.seen.size(), values,
                                             {.max_iterations = iterations,
                                              .function_tolerance = settings.tolerance,
                                              .parameter_tolerance = settings.tolerance,
                                              .gradient_tolerance = 1e-16});
  if (problem.failure) std::rethrow_exception(problem.failure);
  std::vector<double> x;
  for (const BoundedValue& value : values) x.push_back(value.value);
  problem.base = problem.values(x.data());
  return result;
}

bool at_bound(const Parameter& p, double value, double scale) {
  const double near = 1e-8 * scale;
  return value - p.lower <= near || p.upper - value <= near;
}

/// The solver projects its steps onto bounds, and then creeps along them. Parameters at a bound
/// towards which the cost decreases are therefore held there while the others continue alone, and
/// released when the gradient changes sign (active sets; Nocedal & Wright, Numerical Optimization,
/// 2006, 16.5).
Descent solve(Problem& problem, const VectorX& start, const ParameterFitSettings& settings) {
  constexpr int kRound = 20;
  Descent attempt;
  problem.base = start;
  problem.moving = problem.free;
  if (!problem.evaluate(start, false)) return attempt;
  double before = kInfinity;
  while (attempt.iterations < settings.max_iterations) {
    const int most = std::min(kRound, settings.max_iterations - attempt.iterations);
    const BoundedResult found = descend(problem, settings, most);
    attempt.iterations += std::max(1, found.iterations);
    if (!found.usable || problem.stopped) return attempt;
    attempt.cost = found.cost;
    attempt.values = problem.base;
    if (!problem.evaluate(problem.base, true)) return attempt;
    std::vector<Eigen::Index> moving;
    for (const Eigen::Index k : problem.free) {
      double slope = 0.0;
      for (const Eigen::Index i : problem.seen) {
        slope += problem.jacobian(i, k) * (problem.prediction[i] - problem.measured[i]);
      }
      const Parameter& p = problem.parameter(k);
      const bool pushed =
          at_bound(p, problem.base[k], problem.scale[k]) &&
          (p.upper - problem.base[k] < problem.base[k] - p.lower ? slope < 0.0 : slope > 0.0);
      if (!pushed) moving.push_back(k);
    }
    const bool settled =
        found.converged &&
        (moving == problem.moving || before - attempt.cost <= settings.tolerance * attempt.cost);
    if (settled || moving.empty()) {
      attempt.converged = true;
      return attempt;
    }
    before = attempt.cost;
    problem.moving = std::move(moving);
  }
  return attempt;
}

VectorX random_start(const Problem& problem, Random& random) {
  VectorX result = problem.starts();
  for (const Eigen::Index k : problem.free) {
    const Parameter& p = problem.parameter(k);
    const double scale = problem.scale[k];
    // Without a bound, the range is the scale.
    const double lower = std::isfinite(p.lower) ? p.lower : p.start - scale;
    const double upper = std::isfinite(p.upper) ? p.upper : p.start + scale;
    result[k] = random.uniform(lower, upper);
  }
  return result;
}

/// Directions, standard errors and intervals from the Jacobian at the solution.
void judge(const Problem& problem, const ParameterFitSettings& settings, ParameterFit& fit) {
  std::vector<Eigen::Index> inner;
  for (const Eigen::Index k : problem.free) {
    if (!fit.parameters[static_cast<std::size_t>(k)].at_bound) inner.push_back(k);
  }
  const auto columns = static_cast<Eigen::Index>(inner.size());
  const auto rows = static_cast<Eigen::Index>(problem.seen.size());
  fit.degrees_of_freedom = static_cast<int>(std::max<Eigen::Index>(rows - columns, 1));
  fit.noise = std::sqrt(fit.cost / fit.degrees_of_freedom);
  fit.covariance = MatrixX::Zero(fit.values.size(), fit.values.size());
  if (columns == 0) return;
  VectorX unit(columns);
  MatrixX scaled(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    const Eigen::Index k = inner[static_cast<std::size_t>(j)];
    const Parameter& p = problem.parameters[static_cast<std::size_t>(k)];
    const bool ratio = p.lower >= 0.0 && fit.values[k] > 0.0;
    unit[j] = ratio ? fit.values[k] : problem.scale[k];
    for (Eigen::Index r = 0; r < rows; ++r) {
      scaled(r, j) = unit[j] * problem.jacobian(problem.seen[static_cast<std::size_t>(r)], k);
    }
  }
  const linalg::Svd svd = linalg::svd(scaled, linalg::SingularVectors::thin_v);
  MatrixX covariance = MatrixX::Zero(columns, columns);
  for (Eigen::Index i = 0; i < columns; ++i) {
    Direction& direction = fit.directions.emplace_back();
    direction.singular_value = svd.values[i];
    direction.relative_error =
        direction.singular_value > 0.0 ? fit.noise / direction.singular_value : kInfinity;
    direction.undetermined =
        direction.singular_value <= kVanishing * svd.values[0] || direction.relative_error > 1.0;
    direction.weights = VectorX::Zero(fit.values.size());
    for (Eigen::Index j = 0; j < columns; ++j) {
      const Eigen::Index k = inner[static_cast<std::size_t>(j)];
      direction.weights[k] = svd.v(j, i);
      if (direction.undetermined && std::abs(svd.v(j, i)) > kPartOfDirection) {
        fit.parameters[static_cast<std::size_t>(k)].determined = false;
      }
    }
    if (direction.undetermined) continue;
    const VectorX part = direction.relative_error * unit.cwiseProduct(svd.v.col(i));
    covariance.noalias() += part * part.transpose();
  }
  const double quantile = student_quantile(0.5 + 0.5 * settings.confidence, fit.degrees_of_freedom);
  for (Eigen::Index j = 0; j < columns; ++j) {
    const Eigen::Index own = inner[static_cast<std::size_t>(j)];
    FittedParameter& p = fit.parameters[static_cast<std::size_t>(own)];
    p.standard_error = p.determined ? std::sqrt(covariance(j, j)) : kInfinity;
    for (Eigen::Index i = 0; i < columns && p.determined; ++i) {
      const Eigen::Index other = inner[static_cast<std::size_t>(i)];
      if (!fit.parameters[static_cast<std::size_t>(other)].determined) continue;
      fit.covariance(own, other) = covariance(j, i);
    }
    p.interval_lower = p.value - quantile * p.standard_error;
    p.interval_upper = p.value + quantile * p.standard_error;
  }
}

}  // namespace

ForwardModel with_differences(Eigen::Index observations,
                              std::function<VectorX(const VectorX&)> predict, VectorX scales,
                              double step) {
  const auto checked = [predict = std::move(predict), observations](const VectorX& parameters) {
    VectorX result = predict(parameters);
    if (result.size() != observations) {
      refuse(ErrorKind::wrong_length, "predict",
             fmt::format("{} predictions, {} measurements", result.size(), observations),
             "predict one for each");
    }
    return result;
  };
  return {observations, [checked, scales = std::move(scales), step](
                            const VectorX& parameters, VectorX& prediction, MatrixX* jacobian) {
            prediction = checked(parameters);
            if (jacobian == nullptr) return;
            VectorX moved = parameters;
            for (Eigen::Index k = 0; k < parameters.size(); ++k) {
              if (scales[k] == 0.0) {
                jacobian->col(k).setZero();
                continue;
              }
              moved[k] = parameters[k] + step * scales[k];
              const double above = moved[k];
              const VectorX high = checked(moved);
              moved[k] = parameters[k] - step * scales[k];
              jacobian->col(k) = (high - checked(moved)) / (above - moved[k]);
              moved[k] = parameters[k];
            }
          }};
}

ParameterFit fit_parameters(const ForwardModel& model, const VectorX& measured,
                            const std::vector<Parameter>& parameters,
                            const ParameterFitSettings& settings) {
  check(model, measured, parameters, settings);
  Problem problem(model, measured, parameters);
  problem.proceed = settings.proceed;
  if (problem.seen.size() < problem.free.size()) {
    refuse(
        ErrorKind::too_few_points, "measured",
        fmt::format("{} measurements for {} parameters", problem.seen.size(), problem.free.size()),
        "measure more, or fix some of the parameters");
  }
  ParameterFit fit;
  const bool starts = problem.evaluate(problem.starts(), false);
  fit.start_cost = starts ? problem.cost() : kInfinity;
  problem.note(problem.starts(), starts);
  Random random(settings.seed);
  Descent best;
  for (int k = 0; k < settings.starts && !problem.stopped; ++k) {
    const VectorX start = k == 0 ? problem.starts() : random_start(problem, random);
    const Descent found = solve(problem, start, settings);
    fit.costs.push_back(found.cost);
    if (found.cost < best.cost) {
      best = found;
      fit.best_start = k;
    }
  }
  if (problem.stopped && problem.progress.cost < best.cost) {
    best.values = problem.progress.values;
    best.cost = problem.progress.cost;
    best.converged = false;
  }
  fit.stopped = problem.stopped;
  if (best.values.size() == 0 || !problem.evaluate(best.values, true)) {
    refuse(ErrorKind::not_converged, "fit", "no start could be simulated",
           "start nearer, narrow the bounds, or try more starts");
  }
  fit.values = best.values;
  fit.iterations = best.iterations;
  fit.converged = best.converged;
  fit.cost = problem.cost();
  fit.prediction = problem.prediction;
  fit.residual = fit.prediction - measured;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const Parameter& p = parameters[k];
    const double value = fit.values[static_cast<Eigen::Index>(k)];
    const bool bound = !p.fixed && at_bound(p, value, problem.scale[static_cast<Eigen::Index>(k)]);
    fit.parameters.push_back(
        {p.name, p.unit, value, p.lower, p.upper, p.fixed, bound, 0.0, value, value, true});
  }
  judge(problem, settings, fit);
  return fit;
}

}  // namespace sinew::identify
