// Binds steps, static equilibria, equilibrium paths and runs of a simulation.
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

statics::StabilityChoice stability_choice(const std::string& name) {
  if (name == "stable") return statics::StabilityChoice::stable;
  if (name == "any") return statics::StabilityChoice::any;
  throw Error(ErrorKind::unknown_choice, {.item = "solve_static(stability)"},
              fmt::format("there is no stability '{}'", name), "use 'stable' or 'any'");
}

statics::StaticReport solve_static(Session& self, double tolerance, int max_iterations,
                                   int max_load_steps, int max_relaxation_steps,
                                   const std::string& stability) {
  if (!(tolerance > 0.0) || max_iterations < 1 || max_load_steps < 1 || max_relaxation_steps < 0) {
    throw Error(ErrorKind::out_of_range, {.item = "solve_static()"},
                fmt::format("tolerance {:g}, max_iterations {} and max_load_steps {} must be "
                            "positive, max_relaxation_steps {} not negative",
                            tolerance, max_iterations, max_load_steps, max_relaxation_steps),
                "leave them out for the defaults");
  }
  return self.solve_static({tolerance, max_iterations, max_load_steps, max_relaxation_steps,
                            stability_choice(stability)});
}

// What follow_path() collects at every point.
struct Visits {
  std::vector<std::vector<Vector3>> values;  // of every effector
  std::vector<SavedState> states;
};

py::dict path_table(const statics::Path& path, const std::vector<model::EffectorModel>& effectors,
                    const Visits& visits) {
  const auto count = static_cast<Eigen::Index>(path.points.size());
  VectorX load_fraction(count), unstable(count);
  py::list events;
  for (Eigen::Index k = 0; k < count; ++k) {
    const statics::PathPoint& point = path.points[static_cast<std::size_t>(k)];
    load_fraction[k] = point.load_fraction;
    unstable[k] = point.negative_pivots;
    events.append(std::string(statics::path_event_name(point.event)));
  }
  py::dict result;
  result["load_fraction"] = copy(load_fraction);
  result["negative_pivots"] = copy(unstable);
  result["event"] = py::module_::import("numpy").attr("array")(events, "U");
  result["limit_load"] = path.limit_load.value_or(std::numeric_limits<double>::quiet_NaN());
  result["status"] = std::string(statics::path_end_name(path.end));
  result["reason"] = path.reason;
  result["states"] = py::cast(visits.states);
  for (std::size_t i = 0; i < effectors.size(); ++i) {
    Points points(count, 3);
    for (Eigen::Index k = 0; k < count; ++k) {
      points.row(k) = visits.values[i][static_cast<std::size_t>(k)].transpose();
    }
    result[py::str(effectors[i].name)] = copy(points);
  }
  return result;
}

void warn_of_early_end(const statics::Path& path) {
  if (path.end != statics::PathEnd::no_equilibrium) return;
  const py::object kind = py::module_::import("sinew.errors").attr("SinewWarning");
  const std::string text = "follow_path() ended early: " + path.reason;
  if (PyErr_WarnEx(kind.ptr(), text.c_str(), 1) != 0) throw py::error_already_set();
}

py::dict follow_path(Session& self, double first_step, double largest_step, double tolerance,
                     int max_points, bool states) {
  sim::Simulation& simulation = self.simulation();
  const auto& effectors = simulation.model().effectors();
  Visits visits{std::vector<std::vector<Vector3>>(effectors.size()), {}};
  const auto path = self.follow_path({first_step, largest_step, tolerance, max_points}, [&] {
    for (std::size_t i = 0; i < effectors.size(); ++i) {
      visits.values[i].push_back(simulation.effector_value(static_cast<int>(i)));
    }
    if (!states) return;
    visits.states.emplace_back(std::make_shared<const run::State>(simulation.state()),
                               simulation.shared_model());
  });
  warn_of_early_end(path);
  return path_table(path, effectors, visits);
}

sim::OnFailure on_failure(bool keep_going) {
  return keep_going ? sim::OnFailure::keep_going : sim::OnFailure::stop;
}

void bind_step(SimulationType& type) {
  type.def(
      "step",
      [](Session& self, const py::object& n, bool keep_going) {
        self.advance(to_count(n, "step(n)"), on_failure(keep_going));
      },
      py::arg("n") = 1, py::kw_only(), py::arg("keep_going") = false,
      R"(step($self, n=1, *, keep_going=False)
--

Advances the simulation by n time steps. Releases the GIL; Ctrl-C interrupts between steps.

Parameters
----------
n : int
    >= 0.
keep_going : bool
    Whether to keep steps that end 'not-in-equilibrium' or 'unphysical', where their state can be
    evaluated, instead of raising. No later step is then 'solved' until reset() or restore(): it is
    at least 'after-failure'.

Raises
------
RunError
    diverged, inverted-in-run, singular-matrix or not-converged, with the step, the body and the
    likely cause. The simulation keeps the last solved state, from which it can go on: with another
    command, for example. `report.status` is that of the failed step.
)");
}

void bind_follow(SimulationType& type) {
  type.def(
          "follow", [](Session& self, bool on) { self.simulation().follow(on); },
          py::arg("on") = true,
          R"(follow($self, on=True)
--

Lets quasi-static steps follow (`equilibrium: following`) from the next step on, unless the scene's
solver.equilibrium or solver.tolerance says otherwise: for a program that steers the robot in real
time without a controller of Sinew. Environments of sinew.gym and the view do this. The setting is an
input: clones have it, states do not.

Parameters
----------
on : bool
    False: back to the default, `converged` without a controller.
)")
      .def_property_readonly(
          "equilibrium",
          [](const Session& self) {
            return self.simulation().equilibrium() == model::Equilibrium::following ? "following"
                                                                                    : "converged";
          },
          "str: when quasi-static steps end: 'converged' or 'following', as the scene says, or by "
          "default.");
}

void bind_solve_static(SimulationType& type) {
  type.def(
      "solve_static", &solve_static, py::kw_only(), py::arg("tolerance") = 1e-10,
      py::arg("max_iterations") = 60, py::arg("max_load_steps") = 256,
      py::arg("max_relaxation_steps") = 200, py::arg("stability") = "stable",
      R"(solve_static($self, *, tolerance=1e-10, max_iterations=60, max_load_steps=256, max_relaxation_steps=200, stability='stable')
--

Solves for a stable static equilibrium under the present inputs, by Newton's method with the exact
tangent and the geometric stiffness of cables.

Rate limits are ignored, and the actuators of a controller hold their efforts. Velocities become
zero; the time does not change. If Newton's method fails, the load is applied in steps; if that
fails, overdamped motion continues from the last load step. An unstable equilibrium (a straight
column beyond its buckling load) is perturbed along its direction of lowest curvature and left for a
stable one.

Parameters
----------
tolerance : float
    Residual relative to the loads, and violation of the actuators' laws relative to the robot's
    size.
max_iterations : int
    Maximum number of Newton iterations per load step.
max_load_steps : int
    Maximum number of load steps: the smallest load increment is its inverse.
max_relaxation_steps : int
    Maximum number of steps of overdamped motion.
stability : str
    'stable', or 'any' to accept an unstable equilibrium, for example to follow an unstable branch.
    See StaticReport.negative_pivots.

Returns
-------
StaticReport

Raises
------
RunError
    not-converged when no equilibrium is found, or none that is stable; the state is then as before.
)");
}

void bind_follow_path(SimulationType& type) {
  type.def(
      "follow_path", &follow_path, py::kw_only(), py::arg("first_step") = 0.01,
      py::arg("largest_step") = 0.05, py::arg("tolerance") = 1e-9, py::arg("max_points") = 500,
      py::arg("states") = true,
      R"(follow_path($self, *, first_step=0.01, largest_step=0.05, tolerance=1e-09, max_points=500, states=True)
--

Follows the path of equilibria while loads and commanded efforts grow in proportion, from the last
ones (none at the start) to the present commands. Arc-length continuation passes limit points, where
solve_static() would jump or fail. No step changes the load by more than 10 % of the full one. The
last point is at the full load or at most 10 % beyond it. Where unstable directions appear without a
limit point (a column buckles), the load there is found to 1 %, and the path continues along the same
branch. Contact friction acts as in a slow motion from point to point.

A path that ends early returns the points that it found, with a SinewWarning; the simulation stays at
the last one.

Parameters
----------
first_step, largest_step : float
    Largest motion of any coordinate per step, as a fraction of the robot's size.
tolerance : float
    Residual relative to the loads.
max_points : int
states : bool
    Whether to keep the state of every point.

Returns
-------
dict
    'load_fraction' (k,); 'negative_pivots' (k,): number of unstable directions at the point; 'event'
    (k,) of str, what the path passed since the point before: 'none', 'limit-point' (the load turned
    back) or 'bifurcation'; 'limit_load': load fraction at the first maximum of the load, NaN without
    one; 'status': 'full-load', 'max-points' or 'no-equilibrium'; 'reason' of an early end; 'states':
    list of SavedState of the points, for restore(); and the value (k, 3) of every effector by name.

Raises
------
Error
    bad-argument if an actuator is commanded in motion or has a drive, or a cable has friction;
    not-in-this-version for curved surfaces with friction, and if contacts alone hold a body.
RunError
    not-converged if the path has no point at all; the state is then that of the start.
)");
}

void bind_run(SimulationType& type) {
  type.def("run", &run, py::arg("duration") = py::none(), py::kw_only(),
           py::arg("record") = py::none(), py::arg("every") = 1, py::arg("progress") = py::none(),
           py::arg("keep_going") = false,
           R"(run($self, duration=None, *, record=None, every=1, progress=None, keep_going=False)
--

Simulates for a time and returns the recorded quantities, including the initial state. A SinewWarning
(strain-range) names library laws that were not tested at the strains of the run, once until reset();
64 states of the run are looked at, and the last.

Parameters
----------
duration : float, optional
    Simulated time, s; by default the scene's, or the length of its signals and targets.
record : list of str, optional
    Keys to return in addition to 'time'; by default all except those "on request" below.
every : int
    Steps between records; the last step is always recorded.
progress : callable, optional
    Called with (steps done, all steps) about ten times per second. It may read and command the
    simulation.
keep_going : bool
    As for step().

Returns
-------
dict of ndarray
    'time' (k,) s; for every actuator effort and motion, 'NAME.tension' (k,) N and
    'NAME.displacement' (k,) m, and their commands 'NAME.tension_command' and
    'NAME.displacement_command', NaN for a quantity that is not commanded (a controller commands
    efforts); for
    every effector 'NAME.position' (k, 3) m or 'NAME.rotation' (k, 3) rad; for every probe
    'NAME.value'; for every sensor 'NAME.measured', 'NAME.true' and 'NAME.sample_time' s, NaN before
    its first sample; for every estimator 'NAME.UNKNOWN' (k, 3) N, 'NAME.UNKNOWN.std' (k, 3) N and
    'NAME.status'; for every contact 'NAME.force' (k, 3) N, 'NAME.normal_force', 'NAME.gap' and so
    on; 'residual' (k,) N and other numbers of the step's report; 'status' (k,) of str; with a
    controller 'NAME.target' (k, 3), 'NAME.error' (k,), 'error' (k,) m and 'controller' (k,) of str.
    On request for every body 'NAME.positions' (k, n, 3) m and 'NAME.velocities'; for the n points
    of a contact 'NAME.points.gap' (k, n) m, 'NAME.points.normal_force' N and so on; 'strain_energy',
    'actuator_work' and so on (k,) J, work from the first record on; 'time.step' (k,) s.

Raises
------
RunError
    As step(). The exception has the arrays recorded so far as `recorded`, as has a
    KeyboardInterrupt.
)");
}

}  // namespace

void bind_simulation_stepping(SimulationType& type) {
  bind_step(type);
  bind_solve_static(type);
  bind_follow(type);
  bind_follow_path(type);
  bind_run(type);
}

}  // namespace sinew::python
