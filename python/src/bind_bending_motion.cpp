// Simulation of bending actuators over time.
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "arrays.hpp"
#include "bending.hpp"
#include "bindings.hpp"
#include "errors.hpp"

namespace sinew::python {

namespace {

using pcc::BendingActuator;
using pcc::BendingMotion;
using pcc::BendingState;
using Shared = std::shared_ptr<BendingActuator>;

Array tips_of(const BendingActuator& actuator, const std::vector<BendingState>& states) {
  Array tips({static_cast<py::ssize_t>(states.size()), py::ssize_t{2}});
  double* to = tips.mutable_data();
  for (const BendingState& state : states) {
    const Eigen::Vector2d tip = actuator.point(state.angle);
    *to++ = tip.x();
    *to++ = tip.y();
  }
  return tips;
}

py::dict simulate(const Shared& self, const py::object& time, const py::object& pressure,
                  std::optional<double> angle, double rate, double longest_step,
                  const std::string& integrator, double spectral_radius) {
  const std::vector<double> times = to_list(time, "simulate(time)", "s");
  const std::vector<double> pressures = to_list(pressure, "simulate(pressure)", "Pa");
  const pcc::BendingMotionSettings settings = to_motion_settings(integrator, spectral_radius);
  const double start = angle ? *angle : pressures.empty() ? 0.0 : self->equilibrium(pressures[0]);
  std::vector<BendingState> states;
  {
    const py::gil_scoped_release release;
    states = pcc::simulate(self, times, pressures, {.angle = start, .rate = rate}, longest_step,
                           settings);
  }
  py::dict result;
  const auto column = [&](const char* name, double BendingState::*member) {
    Array values(static_cast<py::ssize_t>(states.size()));
    double* to = values.mutable_data();
    for (const BendingState& state : states) *to++ = state.*member;
    result[name] = values;
  };
  column("time", &BendingState::time);
  column("pressure", &BendingState::pressure);
  column("angle", &BendingState::angle);
  column("rate", &BendingState::rate);
  column("acceleration", &BendingState::acceleration);
  result["tip"] = tips_of(*self, states);
  return result;
}

BendingMotion make_motion(const Shared& actuator, std::optional<double> angle, double rate,
                          double pressure, double time, const std::string& integrator,
                          double spectral_radius) {
  return at_argument("BendingMotion()", [&] {
    const double start = angle ? *angle : actuator->equilibrium(pressure);
    return BendingMotion(actuator,
                         {.time = time, .angle = start, .rate = rate, .pressure = pressure},
                         to_motion_settings(integrator, spectral_radius));
  });
}

}  // namespace

void bind_bending_history(BendingActuatorClass& type) {
  type.def(
      "simulate", &simulate, py::arg("time"), py::arg("pressure"), py::kw_only(),
      py::arg("angle") = py::none(), py::arg("rate") = 0.0, py::arg("longest_step") = 1e-3,
      py::arg("integrator") = "generalized-alpha", py::arg("spectral_radius") = 0.8,
      R"(simulate($self, time, pressure, *, angle=None, rate=0.0, longest_step=1e-3, integrator='generalized-alpha', spectral_radius=0.8)
--

Simulates the motion under a given pressure over time, by implicit steps.

Parameters
----------
time : (n,) array_like
    s, increasing; steps may be uneven.
pressure : (n,) array_like
    Pa, interpolated linearly.
angle, rate : float, optional
    At time[0], rad and rad/s; by default the equilibrium under pressure[0].
longest_step : float
    s; longer intervals are divided evenly.
integrator : {'quasi-static', 'backward-euler', 'bdf2', 'generalized-alpha'}
spectral_radius : float
    For generalized-alpha: 0 damps fast motion most, 1 conserves energy.

Returns
-------
dict of ndarray
    'time' (s), 'pressure' (Pa), 'angle' (rad), 'rate', 'acceleration', all (n,), and 'tip', (n, 2) m.

Raises
------
Error
    non-monotonic-time, wrong-length, out-of-range.
RunError
    not-converged if no angle satisfies the equation of motion.
)");
}

void bind_bending_motion(py::module_& module) {
  const auto get = [](double BendingState::*member) {
    return [member](const BendingMotion& self) { return self.state().*member; };
  };
  py::class_<BendingMotion>(
      module, "BendingMotion",
      R"(BendingMotion(actuator, *, angle=None, rate=0.0, pressure=0.0, time=0.0, integrator='generalized-alpha', spectral_radius=0.8)
--

Step-by-step simulation of a bending actuator, for control loops.

Parameters
----------
actuator : BendingActuator
angle, rate : float, optional
    Initial values, rad and rad/s; by default the equilibrium under `pressure`.
pressure, time : float
    Initial values, Pa and s.
integrator : {'quasi-static', 'backward-euler', 'bdf2', 'generalized-alpha'}
spectral_radius : float
    For generalized-alpha: 0 damps fast motion most, 1 conserves energy.
)")
      .def(py::init(&make_motion), py::arg("actuator"), py::kw_only(),
           py::arg("angle") = py::none(), py::arg("rate") = 0.0, py::arg("pressure") = 0.0,
           py::arg("time") = 0.0, py::arg("integrator") = "generalized-alpha",
           py::arg("spectral_radius") = 0.8)
      .def(
          "step",
          [](BendingMotion& self, double time_step, double pressure) {
            return self.step(time_step, pressure).angle;
          },
          py::arg("time_step"), py::arg("pressure"), R"(step($self, time_step, pressure)
--

Makes one implicit step.

Parameters
----------
time_step : float
    s; may change from step to step.
pressure : float
    Pressure at the end of the step, Pa.

Returns
-------
float
    Angle at the end of the step, rad.

Raises
------
RunError
    not-converged; the state is then unchanged.
)")
      .def_property_readonly("time", get(&BendingState::time), "float: s.")
      .def_property_readonly("angle", get(&BendingState::angle), "float: rad.")
      .def_property_readonly("rate", get(&BendingState::rate), "float: rad/s.")
      .def_property_readonly("acceleration", get(&BendingState::acceleration), "float: rad/s^2.")
      .def_property_readonly("pressure", get(&BendingState::pressure), "float: Pa.")
      .def_property_readonly(
          "tip",
          [](const BendingMotion& self) {
            const Eigen::Vector2d tip = self.actuator().point(self.state().angle);
            return Array(2, tip.data());
          },
          "(2,) ndarray: lateral coordinate x and height, m.")
      .def("__repr__", [](const BendingMotion& self) {
        return fmt::format("<sinew.pcc.BendingMotion at {:g} s, {:.4g} rad>", self.state().time,
                           self.state().angle);
      });
}

pcc::BendingMotionSettings to_motion_settings(const std::string& integrator,
                                              double spectral_radius) {
  using mechanics::Integrator;
  for (const Integrator choice : {Integrator::quasi_static, Integrator::backward_euler,
                                  Integrator::bdf2, Integrator::generalized_alpha}) {
    if (mechanics::integrator_name(choice) == integrator) return {choice, spectral_radius};
  }
  throw Error(ErrorKind::unknown_choice, {.item = "integrator"},
              fmt::format("there is no '{}'", integrator),
              "use quasi-static, backward-euler, bdf2 or generalized-alpha");
}

}  // namespace sinew::python
