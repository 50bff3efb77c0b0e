// Equilibria and simulation of constant-curvature arms.
#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/core/thread_pool.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/pcc/arm_simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"

namespace sinew::python {

namespace {

using mechanics::Integrator;

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Cells = std::vector<py::ssize_t>;

pcc::ArmStepSettings step_settings(double time_step, const std::string& integrator,
                                   double spectral_radius) {
  pcc::ArmStepSettings settings;
  settings.time_step = time_step;
  settings.spectral_radius = spectral_radius;
  settings.integrator = choose<Integrator>(integrator, "simulate(integrator)",
                                           {{"backward-euler", Integrator::backward_euler},
                                            {"bdf2", Integrator::bdf2},
                                            {"generalized-alpha", Integrator::generalized_alpha}});
  return settings;
}

// Initial values (arms, n), from one row per arm or one row for all.
Rows starts(const py::object& value, const std::string& place, Eigen::Index arms, Eigen::Index n,
            const char* unit) {
  const Array array = to_array(value, place, "numbers");
  if (array.ndim() == 2 && array.shape(0) == arms && array.shape(1) == n) {
    return Eigen::Map<const Rows>(array.data(), arms, n);
  }
  return to_vector(value, place, n, unit).transpose().replicate(arms, 1);
}

// Motions of several arms. Each arm has `steps` rows of torque and steps + 1 rows of positions and
// rates; its first row is the initial state.
struct Motions {
  Eigen::Index steps = 0;
  Eigen::Map<const Rows> torque;
  Eigen::Map<Rows> positions, rates;

  void run(pcc::ArmSimulation& simulation, Eigen::Index arm) {
    Eigen::Index to = arm * (steps + 1);
    simulation.set_state(positions.row(to).transpose(), rates.row(to).transpose());
    VectorX input(torque.cols());
    for (Eigen::Index i = 0; i < steps; ++i) {
      input = torque.row(arm * steps + i).transpose();
      simulation.step(input);
      ++to;
      positions.row(to) = simulation.position().transpose();
      rates.row(to) = simulation.rate().transpose();
    }
  }
};

// Simulates all arms; each thread has a contiguous block. If several arms fail, throws the
// exception of the first one.
void run_all(const std::shared_ptr<const pcc::Arm>& arm, const pcc::ArmStepSettings& settings,
             Motions& motions, int arms, int threads) {
  ThreadPool pool(std::min(threads, std::max(arms, 1)));
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(arms));
  pool.for_range(arms, 1, [&](int begin, int end, int) {
    pcc::ArmSimulation simulation(arm, settings);
    for (int i = begin; i < end; ++i) {
      try {
        motions.run(simulation, i);
      } catch (...) {
        failures[static_cast<std::size_t>(i)] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

py::tuple simulate(PccArm& self, const py::object& theta, const py::object& theta_dot,
                   const py::object& torque, double time_step, const std::string& integrator,
                   double spectral_radius, int threads) {
  const Eigen::Index n = self.arm->coordinates();
  const pcc::ArmStepSettings settings = step_settings(time_step, integrator, spectral_radius);
  const pcc::ArmSimulation check(self.arm, settings);
  const Array drive = to_array(torque, "simulate(torque)", "(steps, inputs) N m");
  const bool many = drive.ndim() == 3;
  if ((!many && drive.ndim() != 2) || drive.shape(drive.ndim() - 1) != self.arm->inputs()) {
    throw Error(
        ErrorKind::wrong_shape, {.item = "simulate(torque)"},
        fmt::format("it is not an array (steps, {0}) or (arms, steps, {0})", self.arm->inputs()),
        "give the torques of every step in N m, a column for each input");
  }
  const Eigen::Index arms = many ? drive.shape(0) : 1, steps = drive.shape(many ? 1 : 0);
  const Rows start = starts(theta, "simulate(theta)", arms, n, "rad");
  const Rows speed = starts(theta_dot, "simulate(theta_dot)", arms, n, "rad/s");
  const Cells shape = many ? Cells{arms, steps + 1, n} : Cells{steps + 1, n};
  Array positions(shape), rates(shape);
  Motions motions{steps,
                  {drive.data(), arms * steps, self.arm->inputs()},
                  {positions.mutable_data(), arms * (steps + 1), n},
                  {rates.mutable_data(), arms * (steps + 1), n}};
  for (Eigen::Index i = 0; i < arms; ++i) {
    motions.positions.row(i * (steps + 1)) = start.row(i);
    motions.rates.row(i * (steps + 1)) = speed.row(i);
  }
  {
    const py::gil_scoped_release release;
    run_all(self.arm, settings, motions, static_cast<int>(arms), threads);
  }
  return py::make_tuple(positions, rates);
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

(coordinates,) rad: the equilibrium found by descent from `start` (by default straight).

Raises
------
RunError
    not-converged.)");
}

void bind_simulate(PccArmClass& arm) {
  arm.def(
      "simulate", &simulate, py::arg("theta"), py::arg("theta_dot"), py::arg("torque"),
      py::kw_only(), py::arg("time_step") = 1e-3, py::arg("integrator") = "generalized-alpha",
      py::arg("spectral_radius") = 0.8, py::arg("threads") = 1,
      R"(simulate($self, theta, theta_dot, torque, *, time_step=0.001, integrator='generalized-alpha', spectral_radius=0.8, threads=1)
--

Simulates the motion under given torques by implicit steps, for one arm or many equal ones. Releases the GIL.

Parameters
----------
theta, theta_dot : (coordinates,) or (arms, coordinates) rad, rad/s
    Initial values.
torque : (steps, inputs) or (arms, steps, inputs) N m
    Torques at the end of each step.
time_step : float
    s.
integrator : str
    "generalized-alpha", "bdf2" or "backward-euler".
spectral_radius : float
    For generalized-alpha, 0 to 1.
threads : int
    Number of threads that share the arms, 1 or more. The results are the same, bit for bit, for any number, and for each arm alone.

Returns
-------
tuple of (steps + 1, coordinates) or (arms, steps + 1, coordinates)
    theta in rad and theta_dot in rad/s, including the start.

Raises
------
Error
    wrong-shape, out-of-range, unknown-choice.
RunError
    not-converged, diverged; the error of the first arm that fails.)");
}

}  // namespace

void bind_arm_simulation(PccArmClass& arm) {
  bind_equilibrium(arm);
  bind_simulate(arm);
}

}  // namespace sinew::python
