// Binds the identification of parameters of any simulation, of drive cylinders and of actuators.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "sinew/identify/actuator_fit.hpp"
#include "sinew/identify/cylinder_fit.hpp"
#include "sinew/identify/parameter_fit.hpp"
#include "sinew/identify/statistics.hpp"

#include "arrays.hpp"
#include "bindings.hpp"

namespace sinew::python {

namespace {

using namespace identify;

identify::Parameter to_parameter(const std::string& name, const py::handle& value) {
  identify::Parameter parameter{.name = name};
  const std::string place = fmt::format("fit(parameters[{}])", name);
  if (!py::isinstance<py::sequence>(value) && !py::isinstance<py::array>(value)) {
    parameter.start = to_number(value, place, "");
    return parameter;
  }
  const std::vector<double> bounds = py::cast<std::vector<double>>(value);
  if (bounds.size() != 3) {
    throw Error(ErrorKind::wrong_shape, {.item = place},
                fmt::format("it has {} numbers", bounds.size()), "give (start, lower, upper)");
  }
  parameter.start = bounds[0];
  parameter.lower = bounds[1];
  parameter.upper = bounds[2];
  return parameter;
}

// Refuses measurements that are missing: they would drop out of the fit without a word.
void require_measured(const VectorX& data) {
  const Eigen::Index missing = data.array().isNaN().count();
  if (missing == 0) return;
  Eigen::Index first = 0;
  while (!std::isnan(data[first])) ++first;
  throw Error(
      ErrorKind::not_finite, {.item = "fit(measured)"},
      fmt::format("{} of {} measurements are nan, the first is number {}, row by row from 0",
                  missing, data.size(), first),
      "leave them out, or give allow_missing=True to fit the others");
}

// Prints the progress of a fit, and ends it at a time limit.
class FitWatch {
 public:
  FitWatch(const py::object& limit, const py::object& progress,
           const std::vector<identify::Parameter>& parameters)
      : parameters_(parameters) {
    if (!limit.is_none()) {
      limit_ = to_number(limit, "fit(time_limit)", "s");
      if (!(limit_ > 0.0)) {
        throw Error(ErrorKind::out_of_range, {.item = "fit(time_limit)"},
                    fmt::format("the limit is {:g} s", limit_), "give a time above 0 s");
      }
    }
    if (py::isinstance<py::function>(progress)) {
      call_ = progress;
    } else {
      prints_ = progress.is_none() ? isatty(STDERR_FILENO) != 0 : py::cast<bool>(progress);
    }
  }
  ~FitWatch() {
    if (printed_) fmt::print(stderr, "\n");
  }
  FitWatch(const FitWatch&) = delete;
  FitWatch& operator=(const FitWatch&) = delete;

  bool proceed(const FitProgress& now) {
    const auto time = std::chrono::steady_clock::now();
    if (call_) (*call_)(now.evaluations, now.cost, by_name(now.values));
    if (prints_ && time - last_ >= std::chrono::seconds(1)) {
      last_ = time;
      printed_ = true;
      fmt::print(stderr, "\r\033[Kfit: {} evaluations, lowest cost {:.4g} at {}", now.evaluations,
                 now.cost, text(now.values));
      std::fflush(stderr);
    }
    return std::chrono::duration<double>(time - begin_).count() < limit_;
  }

 private:
  py::dict by_name(const VectorX& values) const {
    py::dict result;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      result[parameters_[static_cast<std::size_t>(k)].name.c_str()] = values[k];
    }
    return result;
  }
  std::string text(const VectorX& values) const {
    std::string result;
    for (Eigen::Index k = 0; k < std::min<Eigen::Index>(values.size(), 4); ++k) {
      result += fmt::format("{}{} {:.4g}", k == 0 ? "" : ", ",
                            parameters_[static_cast<std::size_t>(k)].name, values[k]);
    }
    return result;
  }

  const std::vector<identify::Parameter>& parameters_;
  double limit_ = std::numeric_limits<double>::infinity();
  std::optional<py::object> call_;
  bool prints_ = false, printed_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now(), last_ = begin_;
};

ParameterFit fit(const py::function& predict, const py::object& measured, const py::dict& given,
                 const std::vector<std::string>& fixed, int starts, std::uint64_t seed,
                 double confidence, double step, int max_iterations, const py::object& time_limit,
                 const py::object& progress, bool allow_missing) {
  std::vector<identify::Parameter> parameters;
  for (const auto& [key, value] : given) {
    parameters.push_back(to_parameter(py::cast<std::string>(key), value));
  }
  for (const std::string& name : fixed) {
    const auto found = std::ranges::find(parameters, name, &identify::Parameter::name);
    if (found == parameters.end()) {
      throw Error(ErrorKind::unknown_name, {.item = name}, "there is no such parameter to fix",
                  "name one of the parameters");
    }
    found->fixed = true;
  }
  const auto flat = [](const MatrixX& matrix) {
    const MatrixX by_row = matrix.transpose();
    return VectorX(Eigen::Map<const VectorX>(by_row.data(), by_row.size()));
  };
  const VectorX data = flat(to_gappy_matrix(measured, "fit(measured)", "(n,) or (n, m)"));
  if (!allow_missing) require_measured(data);
  VectorX scales(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const identify::Parameter& p = parameters[k];
    const double range = p.upper - p.lower;
    scales[static_cast<Eigen::Index>(k)] = p.fixed                ? 0.0
                                           : p.start != 0.0       ? std::abs(p.start)
                                           : std::isfinite(range) ? range
                                                                  : 1.0;
  }
  const auto call = [&](const VectorX& p) {
    py::dict values;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      values[parameters[k].name.c_str()] = p[static_cast<Eigen::Index>(k)];
    }
    try {
      return flat(to_gappy_matrix(predict(values), "fit(predict)", "that of measured"));
    } catch (py::error_already_set& error) {
      // A failed run raises sinew.RunError in Python, and its parameters are rejected.
      const py::object run_error = py::module_::import("sinew.errors").attr("RunError");
      if (!error.matches(run_error)) throw;
      throw Error(ErrorKind::diverged, {.item = "fit(predict)"}, "the run failed");
    }
  };
  FitWatch watch(time_limit, progress, parameters);
  const ParameterFitSettings settings{
      .starts = starts,
      .seed = seed,
      .confidence = confidence,
      .max_iterations = max_iterations,
      .proceed = [&](const FitProgress& now) { return watch.proceed(now); }};
  return fit_parameters(with_differences(data.size(), call, scales, step), data, parameters,
                        settings);
}

template <typename Get>
py::dict by_name(const ParameterFit& fit, const Get& get) {
  py::dict result;
  for (const FittedParameter& p : fit.parameters) result[p.name.c_str()] = get(p);
  return result;
}

py::list fit_directions(const ParameterFit& fit) {
  py::list result;
  for (const Direction& direction : fit.directions) {
    py::dict entry, weights;
    for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
      weights[fit.parameters[k].name.c_str()] = direction.weights[static_cast<Eigen::Index>(k)];
    }
    entry["singular_value"] = direction.singular_value;
    entry["relative_error"] = direction.relative_error;
    entry["undetermined"] = direction.undetermined;
    entry["weights"] = weights;
    result.append(entry);
  }
  return result;
}

std::vector<DriveRecord> to_records(const py::iterable& records) {
  std::vector<DriveRecord> result;
  for (const py::handle& item : records) {
    const auto triple = py::cast<py::tuple>(item);
    if (triple.size() != 3) {
      throw Error(ErrorKind::wrong_shape, {.item = "records"},
                  fmt::format("a record has {} parts", triple.size()),
                  "give (input, output, sample_time)");
    }
    DriveRecord& record = result.emplace_back();
    record.name = fmt::format("record {}", result.size() - 1);
    const auto put = [&](std::size_t part, const char* place) {
      const auto list = to_list(triple[part], place, "");
      return VectorX(
          Eigen::Map<const VectorX>(list.data(), static_cast<Eigen::Index>(list.size())));
    };
    record.input = put(0, "records(input)");
    record.output = put(1, "records(output)");
    record.sample_time = to_number(triple[2], "records(sample_time)", "s");
  }
  return result;
}

py::list trial_list(const std::vector<CylinderTrial>& trials) {
  py::list result;
  for (const CylinderTrial& trial : trials) {
    py::dict entry;
    entry["nrmse"] = trial.nrmse;
    entry["predicted"] = reading(trial.predicted);
    entry["start"] = reading(VectorX(trial.start));
    result.append(entry);
  }
  return result;
}

py::tuple python_fit_cylinder(const py::iterable& records, int block_rows, bool feedthrough) {
  const CylinderFit found =
      fit_cylinder(to_records(records), {.block_rows = block_rows, .feedthrough = feedthrough});
  return py::make_tuple(found.cylinder, found.fit, trial_list(found.trials));
}

py::tuple python_fit_actuator(const py::object& time, const py::object& volume,
                              const py::object& torque, bool linear, double longest_delay) {
  ActuatorRecord record;
  record.name = "record";
  record.time = to_gappy_matrix(time, "fit_actuator(time)", "(n,) s");
  record.volume = to_gappy_matrix(volume, "fit_actuator(volume)", "(n,) m^3");
  record.torque = to_gappy_matrix(torque, "fit_actuator(torque)", "(n,) N m");
  const ActuatorFit found =
      fit_actuator(std::vector<ActuatorRecord>{record}, linear, longest_delay);
  return py::make_tuple(found.actuator, found.fit);
}

}  // namespace

void bind_identify(py::module_& module) {
  py::class_<ParameterFit>(module, "ParameterFit",
                           "Parameters fitted by least squares, with their uncertainty.")
      .def_property_readonly(
          "values",
          [](const ParameterFit& self) {
            return by_name(self, [](const FittedParameter& p) { return p.value; });
          },
          "dict: parameters by name.")
      .def_property_readonly(
          "standard_errors",
          [](const ParameterFit& self) {
            return by_name(self, [](const FittedParameter& p) { return p.standard_error; });
          },
          "dict: standard errors by name; inf if the data do not determine the parameter, 0 if it "
          "is fixed.")
      .def_property_readonly(
          "intervals",
          [](const ParameterFit& self) {
            return by_name(self, [](const FittedParameter& p) {
              return py::make_tuple(p.interval_lower, p.interval_upper);
            });
          },
          "dict of tuple: confidence intervals by name.")
      .def_property_readonly(
          "at_bounds",
          [](const ParameterFit& self) {
            py::list names;
            for (const FittedParameter& p : self.parameters) {
              if (p.at_bound) names.append(p.name);
            }
            return names;
          },
          "list of str: parameters at a bound.")
      .def_property_readonly(
          "directions", &fit_directions,
          "list of dict: combinations of parameters from the best determined to the worst: "
          "'singular_value', 'relative_error', 'undetermined', 'weights' by name.")
      .def_property_readonly("undetermined", &ParameterFit::undetermined,
                             "int: number of directions that the data do not determine.")
      .def_property_readonly(
          "covariance", [](const ParameterFit& self) { return reading(self.covariance); },
          "(parameters, parameters); 0 for those without an interval.")
      .def_property_readonly(
          "prediction", [](const ParameterFit& self) { return reading(self.prediction); },
          "(observations,): measured values, row by row.")
      .def_property_readonly(
          "residual", [](const ParameterFit& self) { return reading(self.residual); },
          "(observations,): predicted minus measured values; nan for missing ones.")
      .def_readonly("cost", &ParameterFit::cost, "float: sum of squared residuals.")
      .def_readonly("start_cost", &ParameterFit::start_cost,
                    "float: sum of squared residuals at the initial guess.")
      .def_readonly("costs", &ParameterFit::costs,
                    "list of float: final cost of each start; inf if it failed.")
      .def_readonly("noise", &ParameterFit::noise, "float: standard deviation of the residuals.")
      .def_readonly("degrees_of_freedom", &ParameterFit::degrees_of_freedom, "int.")
      .def_readonly("iterations", &ParameterFit::iterations, "int: iterations of the best start.")
      .def_readonly("converged", &ParameterFit::converged, "bool.")
      .def_readonly("stopped", &ParameterFit::stopped,
                    "bool: whether the time limit ended the fit, at the best parameters so far.")
      .def("__str__", [](const ParameterFit& self) { return fit_table(self); });

  module.def(
      "fit", &fit, py::arg("predict"), py::arg("measured"), py::arg("parameters"), py::kw_only(),
      py::arg("fixed") = std::vector<std::string>{}, py::arg("starts") = 1, py::arg("seed") = 1,
      py::arg("confidence") = 0.95, py::arg("step") = 1e-5, py::arg("max_iterations") = 100,
      py::arg("time_limit") = py::none(), py::arg("progress") = py::none(),
      py::arg("allow_missing") = false,
      R"(fit(predict, measured, parameters, *, fixed=(), starts=1, seed=1, confidence=0.95, step=1e-5, max_iterations=100, time_limit=None, progress=None, allow_missing=False)
--

Fits named parameters of any simulation by bounded least squares, with derivatives by central differences.

Parameters
----------
predict : callable
    Takes a dict of parameters by name and returns an array of the shape of `measured`. A
    sinew.RunError rejects these parameters; any other exception ends the fit.
measured : (n,) or (n, m)
    Missing values are nan, with `allow_missing`.
parameters : dict
    By name: (start, lower, upper), or a start without bounds.
fixed : list of str
    Names of known parameters.
starts : int
    Number of starts: the given one, then random ones between the bounds.
seed : int
confidence : float
    Level of the confidence intervals.
step : float
    Step of the differences relative to the start of each parameter. Choose it larger for noisy simulations.
max_iterations : int
time_limit : float, optional
    s. The fit ends after the prediction that exceeds it, at the best parameters so far; `stopped` is then true. The
    intervals need two more predictions for each parameter.
progress : bool or callable, optional
    Whether to print the lowest cost and its parameters every second; by default if standard error is a terminal. A
    callable gets the number of evaluations, the lowest cost, and its parameters by name after each evaluation.
allow_missing : bool
    Whether measurements may be nan, which are left out of the fit.

Returns
-------
ParameterFit

Raises
------
Error
    contradictory-limits, out-of-range, wrong-length, too-few-points, not-converged; not-finite: a
    measurement is nan.)");
  module.def(
      "nrmse",
      [](const py::object& predicted, const py::object& measured) {
        return nrmse(to_gappy_matrix(predicted, "nrmse(predicted)", "(n,) or (n, m)"),
                     to_gappy_matrix(measured, "nrmse(measured)", "(n,) or (n, m)"));
      },
      py::arg("predicted"), py::arg("measured"), R"(nrmse(predicted, measured)
--

Normalised error ``|predicted - measured| / |measured - mean|`` over the available values, with a mean for each column.)");
  module.def("fit_cylinder", &python_fit_cylinder, py::arg("records"), py::kw_only(),
             py::arg("block_rows") = 10, py::arg("feedthrough") = false,
             R"(fit_cylinder(records, *, block_rows=10, feedthrough=False)
--

Identifies a drive cylinder with two states from records: initial guess by a subspace method, then output-error minimisation.

Parameters
----------
records : list of (input, output, sample_time)
    (samples,), (samples,) and s.
block_rows : int
    Block rows of the subspace method's Hankel matrices.
feedthrough : bool
    Whether to fit D as well.

Returns
-------
tuple
    DriveCylinder, ParameterFit, and for each record a dict of 'nrmse', 'predicted' and 'start'.

Raises
------
Error
    too-few-points, out-of-range (an input that does not excite the cylinder), wrong-length.)");
  module.def(
      "validate_cylinder",
      [](const pcc::DriveCylinder& cylinder, const py::iterable& records) {
        return trial_list(validate_cylinder(cylinder, to_records(records)));
      },
      py::arg("cylinder"), py::arg("records"), R"(validate_cylinder(cylinder, records)
--

Predicts records that were not used in the fit: a dict of 'nrmse', 'predicted' and 'start' for each.
The initial state is estimated from the first 20 samples of a record.)");
  module.def("fit_actuator", &python_fit_actuator, py::arg("time"), py::arg("volume"),
             py::arg("torque"), py::kw_only(), py::arg("linear") = false,
             py::arg("longest_delay") = 0.5,
             R"(fit_actuator(time, volume, torque, *, linear=False, longest_delay=0.5)
--

Fits c and the delay (and a) of ``tau = a V(t - delay) + c V(t - delay)**3``.

Parameters
----------
time, volume, torque : (n,) s, m^3, N m
    Missing torques may be nan.
linear : bool
    Whether to fit a as well; otherwise it is zero.
longest_delay : float
    s.

Returns
-------
tuple
    FluidicActuator and ParameterFit.

Raises
------
Error
    non-monotonic-time, too-few-points, wrong-length.)");
}

}  // namespace sinew::python
