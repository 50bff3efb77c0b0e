// Binds the identification of constant-curvature arms from motion capture.
#include <fmt/format.h>

#include "sinew/identify/arm_fit.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"

namespace sinew::python {

namespace {

using namespace identify;
using Actuators = std::vector<pcc::FluidicActuator>;

MotionRecord make_record(const py::object& time, const py::object& positions,
                         const py::object& inputs, const std::string& name) {
  MotionRecord record;
  record.name = name;
  record.time = to_gappy_matrix(time, "MotionRecord(time)", "(samples,) s");
  record.input = MatrixX(record.time.size(), 0);
  if (!inputs.is_none()) {
    record.input = to_gappy_matrix(inputs, "MotionRecord(inputs)", "(samples, inputs)");
  }
  py::array any = py::array::ensure(positions);
  if (!any) PyErr_Clear();
  if (any && any.ndim() == 3) {
    record.position = to_gappy_matrix(any.reshape({any.shape(0), any.shape(1) * any.shape(2)}),
                                      "MotionRecord(positions)", "(samples, segments, 3) m");
  } else {
    record.position =
        to_gappy_matrix(positions, "MotionRecord(positions)", "(samples, segments, 3) m");
  }
  check(record);
  return record;
}

/// An array (samples, segments, 3).
py::array by_segment(const MatrixX& ends) {
  return copy(ends).reshape({ends.rows(), ends.cols() / 3, Eigen::Index{3}});
}

py::array predict(const PccArm& arm, const py::object& time, const py::object& theta,
                  const py::object& theta_dot, const py::object& inputs, const Actuators& actuators,
                  double time_step) {
  MotionRecord record;
  record.name = "predict_motion";
  record.time = to_gappy_matrix(time, "predict_motion(time)", "(samples,) s");
  record.position = MatrixX::Zero(record.time.size(), 3 * arm.arm->segments());
  record.input = MatrixX(record.time.size(), 0);
  if (!inputs.is_none()) {
    record.input = to_gappy_matrix(inputs, "predict_motion(inputs)", "(samples, inputs)");
  }
  check(record);
  ArmStart start{arm.angles(theta, "predict_motion(theta)", "rad"), VectorX()};
  start.rate = theta_dot.is_none() ? VectorX(VectorX::Zero(start.position.size()))
                                   : arm.angles(theta_dot, "predict_motion(theta_dot)", "rad/s");
  return by_segment(predict_motion({arm.arm, actuators}, record, start, {.time_step = time_step}));
}

ArmFit python_fit_arm(const PccArm& arm, const std::vector<MotionRecord>& records,
                      const Actuators& actuators, const std::vector<std::string>& fixed,
                      double mass_spread, double stiffness_spread,
                      std::pair<double, double> damping, double coefficient_spread,
                      double longest_delay, const std::string& start, double time_step, int starts,
                      std::uint64_t seed, double confidence) {
  ArmFitSettings settings;
  settings.mass_spread = mass_spread;
  settings.stiffness_spread = stiffness_spread;
  settings.damping_lower = damping.first;
  settings.damping_upper = damping.second;
  settings.coefficient_spread = coefficient_spread;
  settings.delay_upper = longest_delay;
  settings.fixed = fixed;
  if (start != "at-rest" && start != "moving") {
    throw Error(ErrorKind::unknown_choice, {.item = "fit_arm(start)"},
                fmt::format("there is no '{}'", start), "use 'at-rest' or 'moving'");
  }
  settings.start = start == "moving" ? RecordStart::moving : RecordStart::at_rest;
  settings.step.time_step = time_step;
  settings.search.starts = starts;
  settings.search.seed = seed;
  settings.search.confidence = confidence;
  const py::gil_scoped_release release;
  return fit_arm({arm.arm, actuators}, records, settings);
}

}  // namespace

void bind_identify_arm(py::module_& module) {
  py::class_<MotionRecord>(module, "MotionRecord",
                           R"(MotionRecord(time, positions, inputs=None, *, name='record')

Motion capture of the ends of an arm's segments.

Parameters
----------
time : (samples,) s
    Increasing; may be unevenly spaced.
positions : (samples, segments, 3) m
    nan for missing markers.
inputs : (samples, inputs), optional
    Volumes, m^3, or torques, N m.
name : str

Raises
------
Error
    non-monotonic-time, too-few-points, wrong-length, not-finite.)")
      .def(py::init(&make_record), py::arg("time"), py::arg("positions"),
           py::arg("inputs") = py::none(), py::kw_only(), py::arg("name") = "record")
      .def_readonly("name", &MotionRecord::name, "str.")
      .def_property_readonly(
          "time", [](const MotionRecord& self) { return reading(self.time); }, "(samples,) s.")
      .def_property_readonly(
          "positions", [](const MotionRecord& self) { return by_segment(self.position); },
          "(samples, segments, 3) m.")
      .def_property_readonly(
          "inputs", [](const MotionRecord& self) { return reading(self.input); },
          "(samples, inputs).")
      .def(
          "csv", [](const MotionRecord& self, bool torque) { return motion_csv(self, torque); },
          py::arg("torque") = false, R"(csv($self, torque=False)
--

The table in the format of read_motion(), as str; `torque` says whether the inputs are torques.)");
  module.def("read_motion", &read_motion_record, py::arg("path"), py::arg("segments"),
             R"(read_motion(path, segments)
--

Reads a MotionRecord from a table: "time [s], x_0 [mm], y_0 [mm], z_0 [mm], ..., volume_0 [ml]", with empty cells for gaps.

Parameters
----------
path : path-like
segments : int
    Number of segments; their ends are numbered from 0.

Raises
------
Error
    file-not-found, wrong-columns, malformed-table, non-monotonic-time, too-few-points.)");
  module.def(
      "predict_motion", &predict, py::arg("arm"), py::arg("time"), py::arg("theta"), py::kw_only(),
      py::arg("theta_dot") = py::none(), py::arg("inputs") = py::none(),
      py::arg("actuators") = Actuators{}, py::arg("time_step") = 5e-3,
      R"(predict_motion(arm, time, theta, *, theta_dot=None, inputs=None, actuators=(), time_step=5e-3)
--

Simulates the ends of an arm's segments, (samples, segments, 3) m, at given times.

Parameters
----------
arm : sinew.pcc.Arm
time : (samples,) s
theta, theta_dot : (coordinates,) rad, rad/s
    Values at the first time; rates are zero by default.
inputs : (samples, inputs), optional
    Volumes, m^3, with `actuators`; torques, N m, without.
actuators : list of FluidicActuator
    One for each input.
time_step : float
    Length of the implicit steps, s.)");

  py::class_<RecordFit>(module, "RecordFit", "Prediction of a record by a model.")
      .def_readonly("name", &RecordFit::name, "str.")
      .def_property_readonly(
          "predicted", [](const RecordFit& self) { return by_segment(self.predicted); },
          "(samples, segments, 3) m.")
      .def_property_readonly(
          "theta", [](const RecordFit& self) { return reading(self.start.position); },
          "(coordinates,) rad: angles at its start.")
      .def_property_readonly(
          "theta_dot", [](const RecordFit& self) { return reading(self.start.rate); },
          "(coordinates,) rad/s: rates at its start.")
      .def_readonly("nrmse", &RecordFit::nrmse, "float: NRMSE over all ends.")
      .def_readonly("mean_error", &RecordFit::mean_error, "float: mean distance of an end, m.")
      .def_readonly("summed_error", &RecordFit::summed_error,
                    "float: sum of the distances of all ends over all samples, m.")
      .def_readonly("start_summed_error", &RecordFit::start_summed_error,
                    "float: the same before the fit, m.");
  py::class_<ArmFit>(module, "ArmFit", "An arm identified from motion capture.")
      .def_readonly("fit", &ArmFit::fit, "ParameterFit.")
      .def_property_readonly(
          "arm", [](const ArmFit& self) { return std::make_unique<PccArm>(self.model.arm); },
          "sinew.pcc.Arm: arm with the identified parameters.")
      .def_property_readonly(
          "actuators", [](const ArmFit& self) { return self.model.actuators; },
          "list of FluidicActuator.")
      .def_readonly("records", &ArmFit::records,
                    "list of RecordFit: predictions, in the order of the records.")
      .def_property_readonly(
          "undetermined", &ArmFit::undetermined,
          "int: number of directions of the arm's parameters that the data do not determine.")
      .def("__str__", [](const ArmFit& self) { return fit_table(self.fit, self.own); });
  module.def(
      "fit_arm", &python_fit_arm, py::arg("arm"), py::arg("records"), py::kw_only(),
      py::arg("actuators") = Actuators{}, py::arg("fixed") = std::vector<std::string>{},
      py::arg("mass_spread") = 0.38, py::arg("stiffness_spread") = 0.23,
      py::arg("damping") = std::pair(1e-3, 5e-3), py::arg("coefficient_spread") = 0.9,
      py::arg("longest_delay") = 0.5, py::arg("start") = "at-rest", py::arg("time_step") = 5e-3,
      py::arg("starts") = 1, py::arg("seed") = 1, py::arg("confidence") = 0.95,
      R"(fit_arm(arm, records, *, actuators=(), fixed=(), mass_spread=0.38, stiffness_spread=0.23, damping=(1e-3, 5e-3), coefficient_spread=0.9, longest_delay=0.5, start='at-rest', time_step=5e-3, starts=1, seed=1, confidence=0.95)
--

Fits masses ("mass_0", ...), "stiffness", "damping", and with actuators "coefficient_0", ... and "delay"
of an arm to motion capture, by bounded least squares with exact derivatives.

Parameters
----------
arm : sinew.pcc.Arm
    Initial guess. Stiffnesses and dampings keep their ratios to those of the first segment.
records : list of MotionRecord
    Their inputs are volumes with `actuators`, torques without; none for a passive arm.
actuators : list of FluidicActuator
    Initial guess; one for each input.
fixed : list of str
    Known parameters. Motion alone does not determine a common scale of masses, stiffness, damping and
    coefficients: weigh one segment and fix its mass.
mass_spread, stiffness_spread, coefficient_spread : float
    Bounds, relative to the initial guess.
damping : (lowest, highest)
    Bounds, N m s.
longest_delay : float
    s.
start : {'at-rest', 'moving'}
    Whether records start at rest. The initial angles of each record are fitted, with 'moving' also the rates.
time_step : float
    Length of the implicit steps, s.
starts, seed, confidence
    See fit().

Returns
-------
ArmFit

Raises
------
Error
    empty-list, wrong-length, unknown-name, out-of-range, too-few-points, not-converged.)");
  module.def(
      "validate_arm",
      [](const ArmFit& found, const std::vector<MotionRecord>& records, double time_step) {
        return validate_arm(found.model, records, {.time_step = time_step});
      },
      py::arg("found"), py::arg("records"), py::arg("time_step") = 5e-3,
      R"(validate_arm(found, records, time_step=5e-3)
--

Predicts records that were not used in the fit, each from its first pose at rest. Returns a RecordFit for each.)");
}

}  // namespace sinew::python
