// Binds planning for constant-curvature arms: tasks, plans, replays, regulators.
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/plan/tracking.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"
#include "pcc_arm.hpp"
#include "plan_drive.hpp"
#include "plan_limits.hpp"

namespace sinew::python {

namespace {

/// The class behind sinew.plan.Task.
struct PlanTask {
  std::shared_ptr<const pcc::Arm> arm;
  plan::PlanTask task;
};

struct TrackerOf {
  std::shared_ptr<const pcc::Arm> arm;
  plan::Tracker tracker;
};

PlanTask make_task(const PccArm& of, const py::object& goal, const py::object& torque_limits,
                   const py::object& angle_limits, const py::object& rate_limits,
                   const py::object& torque_rate_limits, double tolerance,
                   const py::object& speed_tolerance, double effort, double tip_speed, double time,
                   double duration, const py::object& duration_range, int intervals,
                   const std::string& method, const py::object& theta, const py::object& theta_dot,
                   const py::object& torque, const std::vector<plan::Obstacle>& obstacles,
                   int backbone_points, const py::object& actuators, const py::object& cylinders,
                   const py::object& lead, const py::object& command_rate_limits, double command) {
  const pcc::Arm& arm = *of.arm;
  plan::PlanTask task;
  task.goal.position = to_vector3(goal, "Task(goal)", "m");
  task.goal.tolerance = tolerance;
  task.goal.speed_tolerance = speed_tolerance.is_none()
                                  ? plan::kNoBound
                                  : to_number(speed_tolerance, "Task(speed_tolerance)", "m/s");
  task.limits = to_limits(arm, torque_limits, angle_limits);
  task.limits.rate = to_optional(rate_limits, "Task(rate_limits)", arm.coordinates(), "rad/s");
  task.limits.torque_rate =
      to_optional(torque_rate_limits, "Task(torque_rate_limits)", arm.inputs(), "N m/s");
  task.limits.command_rate =
      to_optional(command_rate_limits, "Task(command_rate_limits)", arm.inputs(), "1/s");
  task.objective = {effort, tip_speed, time, command};
  task.grid.duration = duration;
  task.grid.intervals = intervals;
  if (!duration_range.is_none()) {
    const auto range = to_list(duration_range, "Task(duration_range)", "s");
    if (range.size() != 2) {
      throw Error(ErrorKind::wrong_shape, {.item = "Task(duration_range)"},
                  fmt::format("{} values are given", range.size()), "give two, in s");
    }
    task.grid.min_duration = range[0];
    task.grid.max_duration = range[1];
  }
  if (method == plan::method_name(plan::CollocationMethod::backward_euler)) {
    task.grid.method = plan::CollocationMethod::backward_euler;
  } else if (method != plan::method_name(plan::CollocationMethod::radau)) {
    throw Error(ErrorKind::unknown_choice, {.item = "Task(method)"},
                fmt::format("there is no '{}'", method), "use 'radau' or 'backward-euler'");
  }
  task.start.position = to_optional(theta, "Task(theta)", arm.coordinates(), "rad");
  task.start.rate = to_optional(theta_dot, "Task(theta_dot)", arm.coordinates(), "rad/s");
  task.start.torque = to_optional(torque, "Task(torque)", arm.inputs(), "N m");
  task.obstacles = obstacles;
  task.backbone_points = backbone_points;
  task.drive = to_drive(actuators, cylinders, lead, "Task");
  return {of.arm, plan::completed(arm, task)};
}

plan::Plan solve(const PlanTask& self, std::uint64_t seed, const plan::Plan* warm, double tolerance,
                 int max_iterations, double max_time, int corrections) {
  if (corrections < 0) {
    throw Error(ErrorKind::out_of_range, {.item = "solve(corrections)"},
                fmt::format("{}", corrections), "give zero or more");
  }
  const py::gil_scoped_release release;
  plan::Planner planner(
      self.arm, self.task,
      {{.tolerance = tolerance, .max_iterations = max_iterations, .max_time = max_time},
       corrections});
  return warm == nullptr ? planner.plan(seed) : planner.replan(*warm);
}

std::shared_ptr<const pcc::Arm> other(const PccArm* arm,
                                      const std::shared_ptr<const pcc::Arm>& own) {
  if (arm == nullptr) return own;
  if (arm->arm->coordinates() != own->coordinates() || arm->arm->inputs() != own->inputs()) {
    throw Error(ErrorKind::wrong_length, {.item = "arm"},
                fmt::format("it has {} coordinates and {} inputs", arm->arm->coordinates(),
                            arm->arm->inputs()),
                fmt::format("give one of {} and {}", own->coordinates(), own->inputs()));
  }
  return arm->arm;
}

void bind_obstacles(py::module_& module) {
  const py::class_<plan::Obstacle> obstacle(
      module, "PlanObstacle", "An obstacle for the arm's axis: a Sphere() or a Plane().");
  module.def(
      "plan_sphere",
      [](const py::object& centre, double radius, double clearance) {
        return plan::Obstacle{.kind = plan::Obstacle::Kind::sphere,
                              .point = to_vector3(centre, "Sphere(centre)", "m"),
                              .radius = radius,
                              .clearance = clearance};
      },
      py::arg("centre"), py::arg("radius"), py::arg("clearance") = 0.0,
      R"(plan_sphere(centre, radius, clearance=0.0)
--

An Obstacle with centre (3,) m and radius in m, from which the axis keeps `clearance` in m.)");
  module.def(
      "plan_plane",
      [](const py::object& point, const py::object& normal, double clearance) {
        return plan::Obstacle{.kind = plan::Obstacle::Kind::plane,
                              .point = to_vector3(point, "Plane(point)", "m"),
                              .normal = to_vector3(normal, "Plane(normal)", ""),
                              .clearance = clearance};
      },
      py::arg("point"), py::arg("normal"), py::arg("clearance") = 0.0,
      R"(plan_plane(point, normal, clearance=0.0)
--

An Obstacle below a plane through a point (3,) m; the normal (3,) points to the free side.)");
}

void bind_plans(py::module_& module) {
  using plan::Plan;
  py::class_<Plan>(module, "Plan", "Result of Task.solve().")
      .def_property_readonly(
          "status", [](const Plan& self) { return std::string(plan::status_name(self.status)); },
          R"(str: 'solved' or 'acceptable' if the program was solved and the motion under its torques ends within
the tolerances and clear of the obstacles; 'not-met-on-replay' if that motion misses;
'infeasible', 'iteration-limit', 'time-limit' or 'failed' if the program was not solved.)")
      .def_property_readonly("found", &Plan::found,
                             "bool: whether the status is solved or acceptable.")
      .def_property_readonly(
          "times", [](const Plan& self) { return reading(self.knots.times); }, "(knots,) s.")
      .def_property_readonly(
          "theta", [](const Plan& self) { return reading(self.knots.position); },
          "(knots, coordinates) rad.")
      .def_property_readonly(
          "theta_dot", [](const Plan& self) { return reading(self.knots.rate); },
          "(knots, coordinates) rad/s.")
      .def_property_readonly(
          "torque", [](const Plan& self) { return reading(self.knots.torque); },
          "(knots, inputs) N m.")
      .def_property_readonly("duration", &Plan::duration, "float: s.")
      .def_property_readonly(
          "objective", [](const Plan& self) { return self.objective; }, "float.")
      .def_property_readonly(
          "tip_error", [](const Plan& self) { return self.tip_error; },
          "float: distance of the tip from the goal at the end of the simulated motion under the "
          "torques, m.")
      .def_property_readonly(
          "tip_speed", [](const Plan& self) { return self.tip_speed; },
          "float: tip speed at the end of that motion, m/s.")
      .def_property_readonly(
          "clearance", [](const Plan& self) { return self.clearance; },
          "float: smallest distance between axis and obstacles in that motion, m; inf without "
          "obstacles.")
      .def_property_readonly(
          "planned_tip_error", [](const Plan& self) { return self.planned_tip_error; },
          "float: distance of the tip from the goal at the last knot, theta[-1], m.")
      .def_property_readonly(
          "planned_tip_speed", [](const Plan& self) { return self.planned_tip_speed; },
          "float: tip speed at the last knot, m/s.")
      .def_property_readonly(
          "iterations", [](const Plan& self) { return self.iterations; },
          "int: iterations of all programs.")
      .def_property_readonly(
          "corrections", [](const Plan& self) { return self.corrections; },
          "int: number of programs solved after the first, with another aim or more knots.")
      .def_property_readonly(
          "seconds", [](const Plan& self) { return self.seconds; },
          "float: computation time of all programs and simulations, s.")
      .def_property_readonly(
          "drive",
          [](const Plan& self) -> py::object {
            if (!self.knots.drive) return py::none();
            return drive_result(*self.knots.drive);
          },
          R"(dict or None: for a task with actuators and cylinders. "times" (samples,) s, from 0, the first command
("lead" s before the plan); (samples, inputs) "command" and "volume" (m^3, delivered under the
commands).)")
      .def(
          "torque_at", [](const Plan& self, double time) { return copy(self.torque(time)); },
          py::arg("time"),
          R"(torque_at($self, time)
--

(inputs,) N m at a time in s: linear between knots, with backward Euler constant; with a drive the torque that
its commands produce.)");
  using plan::Replay;
  py::class_<Replay>(module, "PlanReplay", "An arm's motion at equally spaced times.")
      .def_property_readonly(
          "times", [](const Replay& self) { return reading(self.times); }, "(samples,) s.")
      .def_property_readonly(
          "theta", [](const Replay& self) { return reading(self.position); },
          "(samples, coordinates) rad.")
      .def_property_readonly(
          "theta_dot", [](const Replay& self) { return reading(self.rate); },
          "(samples, coordinates) rad/s.")
      .def_property_readonly(
          "torque", [](const Replay& self) { return reading(self.torque); },
          "(samples, inputs) N m.")
      .def_property_readonly(
          "tip", [](const Replay& self) { return reading(self.tip); }, "(samples, 3) m.")
      .def_property_readonly(
          "tip_velocity", [](const Replay& self) { return reading(self.tip_velocity); },
          "(samples, 3) m/s.")
      .def_property_readonly(
          "tip_error", [](const Replay& self) { return self.tip_error; },
          "float: distance of the tip from the goal at the end, m.")
      .def_property_readonly(
          "tip_speed", [](const Replay& self) { return self.tip_speed; },
          "float: tip speed at the end, m/s.")
      .def_property_readonly(
          "clearance", &Replay::clearance,
          "float: smallest distance between the axis and the obstacles, m; inf without obstacles.");
}

void bind_task(py::module_& module) {
  py::class_<PlanTask>(module, "PlanTask", R"(PlanTask(arm, goal, torque_limits=None, *, ...)

Planning problem: bring an arm's tip to a goal at low final speed with minimal effort.

Parameters
----------
arm : sinew.pcc.Arm
goal : (3,) m
torque_limits : (inputs,) or (2, inputs) N m, optional
    In both directions, or lower and upper limits.
angle_limits : (coordinates,) or (2, coordinates) rad, optional
rate_limits : (coordinates,) or float, rad/s, optional
torque_rate_limits : (inputs,) or float, N m/s, optional
tolerance, speed_tolerance : float
    Of the tip at the end, m and m/s; `speed_tolerance` None: any speed.
effort, tip_speed, time : float
    The cost is effort * integral of torque^2 + tip_speed * |final velocity of the tip|^2
    + time * duration (the last term if the duration is free).
duration : float
    s; with duration_range (shortest, longest) it is free, and this is the initial guess.
intervals : int
    Number of equal intervals of the first mesh; a plan may end with more and uneven ones.
method : str
    "radau" (Radau IIA with three stages) or "backward-euler".
theta, theta_dot, torque : (coordinates,) rad, rad/s and (inputs,) N m, optional
    Initial state; by default straight, at rest and without torque.
obstacles : list of Obstacle
backbone_points : int
    Number of points per segment that keep clear of the obstacles at the knots.
actuators, cylinders : list of FluidicActuator, list of DriveCylinder, optional
    One each for each input; all cylinders have one sample time. The plan then consists of their commands
    (Plan.drive) and respects their dynamics and limits. The duration is fixed.
lead : float, optional
    Time from the first command to the start of the motion, s; by default the longest delay, in whole samples.
command_rate_limits : (inputs,) or float, 1/s, optional
command : float
    Cost of (torque per command * rate of the command)^2, s/(N m)^2, positive.

Raises
------
Error
    wrong-length, wrong-shape, not-finite, out-of-range (a goal beyond the arm's length),
    contradictory-limits (limits that cross), unknown-choice.)")
      .def(py::init(&make_task), py::arg("arm"), py::arg("goal"),
           py::arg("torque_limits") = py::none(), py::kw_only(),
           py::arg("angle_limits") = py::none(), py::arg("rate_limits") = py::none(),
           py::arg("torque_rate_limits") = py::none(), py::arg("tolerance") = 2e-3,
           py::arg("speed_tolerance") = 5e-3, py::arg("effort") = 0.1, py::arg("tip_speed") = 0.0,
           py::arg("time") = 0.0, py::arg("duration") = 1.6, py::arg("duration_range") = py::none(),
           py::arg("intervals") = 50, py::arg("method") = "radau", py::arg("theta") = py::none(),
           py::arg("theta_dot") = py::none(), py::arg("torque") = py::none(),
           py::arg("obstacles") = std::vector<plan::Obstacle>{}, py::arg("backbone_points") = 4,
           py::arg("actuators") = py::none(), py::arg("cylinders") = py::none(),
           py::arg("lead") = py::none(), py::arg("command_rate_limits") = py::none(),
           py::arg("command") = plan::Objective{}.command)
      .def(
          "solve", &solve, py::arg("seed") = 0, py::kw_only(), py::arg("warm") = nullptr,
          py::arg("tolerance") = 1e-6, py::arg("max_iterations") = 300, py::arg("max_time") = 30.0,
          py::arg("corrections") = plan::PlannerSettings{}.corrections,
          R"(solve($self, seed=0, *, warm=None, tolerance=1e-06, max_iterations=300, max_time=30.0, corrections=6)
--

Solves the problem and returns a Plan; check its status. The motion under its torques is simulated with its own error
control. If it misses the tolerances at the goal or the clearance of an obstacle, the program is solved again
with a shifted aim, or with more knots where they are too coarse.

Parameters
----------
seed : int
    Seed of the random torques whose motion is the initial guess.
warm : Plan, optional
    Plan of a similar task as the initial guess, on its knots.
tolerance : float
    Of the solver, scaled.
max_iterations : int
    For each program.
max_time : float
    For all programs together, s.
corrections : int
    Maximum number of programs after the first; 0: the first one unchanged.

Raises
------
Error
    wrong-length: `warm` belongs to another kind of task.)")
      .def(
          "replay",
          [](const PlanTask& self, const plan::Plan& of, const PccArm* arm, double time_step) {
            const auto on = other(arm, self.arm);
            const py::gil_scoped_release release;
            return plan::replay(on, self.task, of, time_step);
          },
          py::arg("plan"), py::arg("arm") = nullptr, py::kw_only(), py::arg("time_step") = 1e-3,
          R"(replay($self, plan, arm=None, *, time_step=0.001)
--

Simulates the plan's torques on the arm, or on another one, far more accurately than the plan's mesh: a Replay,
in samples `time_step` (s) apart.)")
      .def(
          "replay_commands",
          [](const PlanTask& self, const py::object& command, const py::object& actuators,
             const py::object& cylinders, double lead, const PccArm* arm, double time_step) {
            const auto on = other(arm, self.arm);
            auto drive = to_drive(actuators, cylinders, py::float_(lead), "replay_commands");
            if (!drive) drive = self.task.drive;
            const plan::DriveRun run(
                drive ? drive->channels : std::vector<plan::DriveChannel>{},
                to_matrix(command, "replay_commands(command)", "(samples, inputs)"), lead);
            const py::gil_scoped_release release;
            return plan::replay(on, self.task, run, time_step);
          },
          py::arg("command"), py::arg("actuators") = py::none(), py::arg("cylinders") = py::none(),
          py::kw_only(), py::arg("lead"), py::arg("arm") = nullptr, py::arg("time_step") = 1e-3,
          R"(replay_commands($self, command, actuators=None, cylinders=None, *, lead, arm=None, time_step=0.001)
--

Simulates commands (samples, inputs) through the whole chain, cylinders, lines, actuators and the arm or
another one, with the accuracy of replay(): a Replay of lead + duration whose times begin with the
commands. Actuators and cylinders are by default the task's; everything is initially at rest.)");
}

void bind_tracker(py::module_& module) {
  py::class_<TrackerOf>(module, "PlanTracker", R"(PlanTracker(task, plan, *, ...)

A time-varying linear quadratic regulator along a plan.

Parameters
----------
task : Task
plan : Plan
time_step : float
    Time for which a torque is held, s.
angle, rate : float
    Errors (rad, rad/s) along the way that cost as much as ...
torque_fraction : float
    ... this fraction of an input's range, and as much as ...
tip_position, tip_speed : float
    ... these errors of the tip at the end (m, m/s).

Raises
------
Error
    out-of-range.)")
      .def(py::init([](const PlanTask& task, const plan::Plan& of, double time_step, double angle,
                       double rate, double torque_fraction, double tip_position, double tip_speed) {
             return TrackerOf{task.arm, plan::Tracker(task.arm, task.task, of,
                                                      {time_step, angle, rate, torque_fraction,
                                                       tip_position, tip_speed})};
           }),
           py::arg("task"), py::arg("plan"), py::kw_only(), py::arg("time_step") = 5e-3,
           py::arg("angle") = 0.5, py::arg("rate") = 5.0, py::arg("torque_fraction") = 0.5,
           py::arg("tip_position") = 5e-3, py::arg("tip_speed") = 5e-2)
      .def_property_readonly(
          "steps", [](const TrackerOf& self) { return self.tracker.steps(); }, "int.")
      .def_property_readonly(
          "time_step", [](const TrackerOf& self) { return self.tracker.time_step(); },
          "float: control step, s; the plan's duration is a whole multiple of it.")
      .def(
          "gain",
          [](const TrackerOf& self, int step) {
            if (step < 0 || step >= self.tracker.steps()) {
              throw Error(ErrorKind::out_of_range, {.item = "step"}, fmt::format("{}", step),
                          fmt::format("give 0 to {}", self.tracker.steps() - 1));
            }
            return copy(self.tracker.gain(step));
          },
          py::arg("step"), R"(gain($self, step)
--

(inputs, 2 coordinates): torque = nominal - gain (state - nominal), N m per rad and rad/s.)")
      .def(
          "run",
          [](const TrackerOf& self, const PccArm* arm, const py::object& theta,
             const py::object& theta_dot, bool feedback, double time_step) {
            const auto on = other(arm, self.arm);
            const plan::TrackingTrial trial{
                to_optional(theta, "run(theta)", on->coordinates(), "rad"),
                to_optional(theta_dot, "run(theta_dot)", on->coordinates(), "rad/s"), feedback,
                time_step};
            const py::gil_scoped_release release;
            return plan::track(on, self.tracker, trial);
          },
          py::arg("arm") = nullptr, py::kw_only(), py::arg("theta") = py::none(),
          py::arg("theta_dot") = py::none(), py::arg("feedback") = true,
          py::arg("time_step") = 1e-3,
          R"(run($self, arm=None, *, theta=None, theta_dot=None, feedback=True, time_step=0.001)
--

Simulates the arm, or another one, under the plan with feedback: a Replay.

Parameters
----------
arm : sinew.pcc.Arm, optional
    An arm with other masses and stiffnesses.
theta, theta_dot : (coordinates,) rad, rad/s, optional
    Other initial values.
feedback : bool
    False: only the plan's torques.
time_step : float
    Step of the simulation, s.)");
}

}  // namespace

void bind_plan(py::module_& module) {
  bind_obstacles(module);
  bind_plans(module);
  bind_task(module);
  bind_tracker(module);
}

}  // namespace sinew::python
