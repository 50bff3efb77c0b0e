// Equilibria and motions of an arm of constant curvature.
#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"

namespace sinew::python {

namespace {

using mechanics::Integrator;

py::tuple simulate(PccArm& self, const py::object& theta, const py::object& theta_dot,
                   const py::object& torque, double time_step, const std::string& integrator,
                   double spectral_radius) {
  const Eigen::Index n = self.arm->coordinates();
  pcc::ArmStepSettings settings;
  settings.time_step = time_step;
  settings.spectral_radius = spectral_radius;
  settings.integrator = choose<Integrator>(integrator, "simulate(integrator)",
                                           {{"backward-euler", Integrator::backward_euler},
                                            {"bdf2", Integrator::bdf2},
                                            {"generalized-alpha", Integrator::generalized_alpha}});
  const VectorX start = to_vector(theta, "simulate(theta)", n, "rad");
  const VectorX speed = to_vector(theta_dot, "simulate(theta_dot)", n, "rad/s");
  const MatrixX drive = to_matrix(torque, "simulate(torque)", "(steps, inputs) N m");
  if (drive.cols() != self.arm->inputs()) {
    throw Error(
        ErrorKind::wrong_shape, {.item = "simulate(torque)"},
        fmt::format("it has {} columns, the arm {} inputs", drive.cols(), self.arm->inputs()),
        "give an array (steps, inputs) N m");
  }
  MatrixX positions(drive.rows() + 1, n), rates(drive.rows() + 1, n);
  {
    const py::gil_scoped_release release;
    pcc::ArmSimulation simulation(self.arm, settings);
    simulation.set_state(start, speed);
    positions.row(0) = start.transpose();
    rates.row(0) = speed.transpose();
    VectorX input(drive.cols());
    for (Eigen::Index i = 0; i < drive.rows(); ++i) {
      input = drive.row(i).transpose();
      simulation.step(input);
      positions.row(i + 1) = simulation.position().transpose();
      rates.row(i + 1) = simulation.rate().transpose();
    }
  }
  return py::make_tuple(copy(positions), copy(rates));
}

void bind_equilibrium(PccArmClass& arm) {
  arm.def(
      "equilibrium",
      [](PccArm& self, const py::object& torque, const py::object& start) {
        const VectorX from = start.is_none() ? VectorX(VectorX::Zero(self.arm->coordinates()))
                                             : self.angles(start, "equilibrium(start)", "rad");
        return copy(pcc::find_equilibrium(
                        self.equations,
                        to_vector(torque, "equilibrium(torque)", self.arm->inputs(), "N m"), from)
                        .position);
      },
      py::arg("torque"), py::arg("start") = py::none(),
      R"(equilibrium($self, torque, start=None)
--

(coordinates,) rad: the equilibrium that a descent from `start` (straight) ends in.

Raises
------
RunError
    not-converged.)");
}

void bind_simulate(PccArmClass& arm) {
  arm.def(
      "simulate", &simulate, py::arg("theta"), py::arg("theta_dot"), py::arg("torque"),
      py::kw_only(), py::arg("time_step") = 1e-3, py::arg("integrator") = "generalized-alpha",
      py::arg("spectral_radius") = 0.8,
      R"(simulate($self, theta, theta_dot, torque, *, time_step=0.001, integrator='generalized-alpha', spectral_radius=0.8)
--

Motion under given torques, by implicit steps; the GIL is released.

Parameters
----------
theta, theta_dot : (coordinates,) rad, rad/s
    The start.
torque : (steps, inputs) N m
    At the end of each step.
time_step : float
    s.
integrator : str
    "generalized-alpha", "bdf2" or "backward-euler".
spectral_radius : float
    Of generalized-alpha, 0 to 1.

Returns
-------
tuple of (steps + 1, coordinates)
    theta in rad and theta_dot in rad/s, the start included.

Raises
------
RunError
    not-converged, diverged.)");
}

}  // namespace

void bind_arm_simulation(PccArmClass& arm) {
  bind_equilibrium(arm);
  bind_simulate(arm);
}

}  // namespace sinew::python
