// Planning for constant-curvature arms: tasks, plans, replays, regulators, static reach.
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/plan/reach.hpp"
#include "sinew/plan/tracking.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"
#include "pcc_arm.hpp"
#include "plan_limits.hpp"

namespace sinew::python {

namespace {

/// What Python knows as sinew.plan.Task.
struct PlanTask {
  std::shared_ptr<const pcc::Arm> arm;
  plan::Task task;
};

struct TrackerOf {
  std::shared_ptr<const pcc::Arm> arm;
  plan::Tracker tracker;
};

/// Lower and upper limits from (n,), either way, or (2, n).
void set_limits(const py::object& value, const std::string& place, Eigen::Index n,
                const std::string& unit, VectorX& lower, VectorX& upper) {
  if (value.is_none()) return;
  const Array array =
      to_array(value, place, fmt::format("({},) either way or (2, {}) {}", n, n, unit));
  if (array.ndim() == 2) {
    const MatrixX both = to_matrix(value, place, fmt::format("(2, {}) {}", n, unit));
    if (both.rows() != 2 || both.cols() != n) {
      throw Error(ErrorKind::wrong_shape, {.item = place},
                  fmt::format("its shape is ({}, {})", both.rows(), both.cols()),
                  fmt::format("give ({},), or (2, {}) with the lower ones first", n, n));
    }
    lower = both.row(0);
    upper = both.row(1);
    return;
  }
  upper = array.ndim() == 0 ? VectorX(VectorX::Constant(n, array.data()[0]))
                            : to_vector(value, place, n, unit);
  lower = -upper;
}

VectorX optional(const py::object& value, const std::string& place, Eigen::Index n,
                 const std::string& unit) {
  if (value.is_none()) return {};
  const Array array = to_array(value, place, fmt::format("({},) {}", n, unit));
  if (array.ndim() == 0) return VectorX::Constant(n, array.data()[0]);
  return to_vector(value, place, n, unit);
}

}  // namespace

plan::Limits reach_limits(const pcc::Arm& arm, const py::object& torque, const py::object& angle) {
  plan::Limits limits;
  set_limits(torque, "torque_limits", arm.inputs(), "N m", limits.torque_lower,
             limits.torque_upper);
  set_limits(angle, "angle_limits", arm.coordinates(), "rad", limits.angle_lower,
             limits.angle_upper);
  return limits;
}

namespace {

PlanTask make_task(const PccArm& of, const py::object& goal, const py::object& torque_limits,
                   const py::object& angle_limits, const py::object& rate_limits,
                   const py::object& torque_rate_limits, double tolerance,
                   const py::object& speed_tolerance, double effort, double tip_speed, double time,
                   double duration, const py::object& duration_range, int intervals,
                   const std::string& method, const py::object& theta, const py::object& theta_dot,
                   const py::object& torque, const std::vector<plan::Obstacle>& obstacles,
                   int backbone_points) {
  const pcc::Arm& arm = *of.arm;
  plan::Task task;
  task.goal.position = to_vector3(goal, "Task(goal)", "m");
  task.goal.tolerance = tolerance;
  task.goal.speed_tolerance = speed_tolerance.is_none()
                                  ? plan::kNoBound
                                  : to_number(speed_tolerance, "Task(speed_tolerance)", "m/s");
  task.limits = reach_limits(arm, torque_limits, angle_limits);
  task.limits.rate = optional(rate_limits, "Task(rate_limits)", arm.coordinates(), "rad/s");
  task.limits.torque_rate =
      optional(torque_rate_limits, "Task(torque_rate_limits)", arm.inputs(), "N m/s");
  task.objective = {effort, tip_speed, time};
  task.grid.duration = duration;
  task.grid.intervals = intervals;
  if (!duration_range.is_none()) {
    const auto range = to_list(duration_range, "Task(duration_range)", "s");
    if (range.size() != 2) {
      throw Error(ErrorKind::wrong_shape, {.item = "Task(duration_range)"},
                  fmt::format("{} values are given", range.size()), "give two, in s");
    }
    task.grid.least_duration = range[0];
    task.grid.most_duration = range[1];
  }
  if (method == plan::method_name(plan::Method::backward_euler)) {
    task.grid.method = plan::Method::backward_euler;
  } else if (method != plan::method_name(plan::Method::hermite_simpson)) {
    throw Error(ErrorKind::unknown_choice, {.item = "Task(method)"},
                fmt::format("there is no '{}'", method),
                "use 'hermite-simpson' or 'backward-euler'");
  }
  task.start.position = optional(theta, "Task(theta)", arm.coordinates(), "rad");
  task.start.rate = optional(theta_dot, "Task(theta_dot)", arm.coordinates(), "rad/s");
  task.start.torque = optional(torque, "Task(torque)", arm.inputs(), "N m");
  task.obstacles = obstacles;
  task.backbone_points = backbone_points;
  return {of.arm, plan::completed(arm, task)};
}

plan::Plan solve(const PlanTask& self, std::uint64_t seed, const plan::Plan* warm, double tolerance,
                 int max_iterations, double max_time) {
  const py::gil_scoped_release release;
  plan::Planner planner(
      self.arm, self.task,
      {.tolerance = tolerance, .max_iterations = max_iterations, .max_time = max_time});
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
  py::class_<plan::Obstacle>(module, "PlanObstacle",
                             "What the arm's axis keeps clear of: a Sphere() or a Plane().");
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

An Obstacle of centre (3,) m and radius in m, from which the axis keeps `clearance` in m.)");
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

An Obstacle through a point (3,) m; its normal (3,) points to where the arm may be.)");
}

void bind_plans(py::module_& module) {
  using plan::Plan;
  py::class_<Plan>(module, "Plan", "What Task.solve() found.")
      .def_property_readonly(
          "status", [](const Plan& self) { return std::string(plan::status_name(self.status)); },
          "str: 'solved', 'acceptable', 'infeasible', 'iteration-limit', 'time-limit' or "
          "'failed'.")
      .def_property_readonly("found", &Plan::found, "bool: solved or acceptable.")
      .def_property_readonly(
          "times", [](const Plan& self) { return copy(self.knots.times); }, "(knots,) s.")
      .def_property_readonly(
          "theta", [](const Plan& self) { return copy(self.knots.position); },
          "(knots, coordinates) rad.")
      .def_property_readonly(
          "theta_dot", [](const Plan& self) { return copy(self.knots.rate); },
          "(knots, coordinates) rad/s.")
      .def_property_readonly(
          "torque", [](const Plan& self) { return copy(self.knots.torque); },
          "(knots, inputs) N m.")
      .def_property_readonly("duration", &Plan::duration, "float: s.")
      .def_property_readonly(
          "objective", [](const Plan& self) { return self.objective; }, "float.")
      .def_property_readonly(
          "tip_error", [](const Plan& self) { return self.tip_error; },
          "float: m, of the plan itself, at its end.")
      .def_property_readonly(
          "tip_speed", [](const Plan& self) { return self.tip_speed; },
          "float: m/s, of the plan itself, at its end.")
      .def_property_readonly(
          "iterations", [](const Plan& self) { return self.iterations; }, "int.")
      .def_property_readonly(
          "seconds", [](const Plan& self) { return self.seconds; }, "float: of the solver.")
      .def(
          "torque_at", [](const Plan& self, double time) { return copy(self.torque(time)); },
          py::arg("time"),
          R"(torque_at($self, time)
--

(inputs,) N m at a time in s: linear between knots, with backward Euler constant.)");
  using plan::Replay;
  py::class_<Replay>(module, "PlanReplay", "An arm's motion over equal steps.")
      .def_property_readonly(
          "times", [](const Replay& self) { return copy(self.times); }, "(steps + 1,) s.")
      .def_property_readonly(
          "theta", [](const Replay& self) { return copy(self.position); },
          "(steps + 1, coordinates) rad.")
      .def_property_readonly(
          "theta_dot", [](const Replay& self) { return copy(self.rate); },
          "(steps + 1, coordinates) rad/s.")
      .def_property_readonly(
          "torque", [](const Replay& self) { return copy(self.torque); },
          "(steps + 1, inputs) N m.")
      .def_property_readonly(
          "tip", [](const Replay& self) { return copy(self.tip); }, "(steps + 1, 3) m.")
      .def_property_readonly(
          "tip_velocity", [](const Replay& self) { return copy(self.tip_velocity); },
          "(steps + 1, 3) m/s.")
      .def_property_readonly(
          "tip_error", [](const Replay& self) { return self.tip_error; }, "float: m, at the end.")
      .def_property_readonly(
          "tip_speed", [](const Replay& self) { return self.tip_speed; }, "float: m/s, at the end.")
      .def_property_readonly(
          "clearance", [](const Replay& self) { return self.clearance; },
          "float: m, the least between the axis and the obstacles; inf without any.");
}

void bind_task(py::module_& module) {
  py::class_<PlanTask>(module, "PlanTask", R"(PlanTask(arm, goal, torque_limits=None, *, ...)

Bring an arm's tip to a goal, slow, by the least effort.

Parameters
----------
arm : sinew.pcc.Arm
goal : (3,) m
torque_limits : (inputs,) or (2, inputs) N m, optional
    Either way, or lower and upper ones.
angle_limits : (coordinates,) or (2, coordinates) rad, optional
rate_limits : (coordinates,) or float, rad/s, optional
torque_rate_limits : (inputs,) or float, N m/s, optional
tolerance, speed_tolerance : float
    Of the tip at the end, m and m/s; `speed_tolerance` None: any speed.
effort, tip_speed, time : float
    The cost is effort * integral of torque^2 + tip_speed * |tip's velocity at the end|^2
    + time * duration (the last where the duration is free).
duration : float
    s; with duration_range (least, most) it is free and this its first guess.
intervals : int
method : str
    "hermite-simpson" or "backward-euler".
theta, theta_dot, torque : (coordinates,) rad, rad/s and (inputs,) N m, optional
    The start; straight, at rest, without torque when left out.
obstacles : list of Obstacle
backbone_points : int
    A segment, that keep clear of the obstacles at the knots.

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
           py::arg("intervals") = 50, py::arg("method") = "hermite-simpson",
           py::arg("theta") = py::none(), py::arg("theta_dot") = py::none(),
           py::arg("torque") = py::none(), py::arg("obstacles") = std::vector<plan::Obstacle>{},
           py::arg("backbone_points") = 4)
      .def("solve", &solve, py::arg("seed") = 0, py::kw_only(), py::arg("warm") = nullptr,
           py::arg("tolerance") = 1e-6, py::arg("max_iterations") = 300, py::arg("max_time") = 30.0,
           R"(solve($self, seed=0, *, warm=None, tolerance=1e-06, max_iterations=300, max_time=30.0)
--

A Plan; look at its status.

Parameters
----------
seed : int
    Of the random torques whose motion is the first guess.
warm : Plan, optional
    Of a similar task with as many intervals: start there instead.
tolerance : float
    Of the solver, scaled.
max_iterations, max_time : int, float
    The latter in s.

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

The plan's torque on the arm, or on another one, in fine implicit steps: a Replay.)");
}

void bind_tracker(py::module_& module) {
  py::class_<TrackerOf>(module, "PlanTracker", R"(PlanTracker(task, plan, *, ...)

A linear quadratic regulator of variable gain along a plan.

Parameters
----------
task : Task
plan : Plan
time_step : float
    s, for which a torque is held.
angle, rate : float
    Errors (rad, rad/s) on the way that are as bad as ...
torque_share : float
    ... this part of an input's range, and as bad as ...
tip_position, tip_speed : float
    ... these of the tip at the end (m, m/s).

Raises
------
Error
    out-of-range.)")
      .def(py::init([](const PlanTask& task, const plan::Plan& of, double time_step, double angle,
                       double rate, double torque_share, double tip_position, double tip_speed) {
             return TrackerOf{task.arm, plan::Tracker(task.arm, task.task, of,
                                                      {time_step, angle, rate, torque_share,
                                                       tip_position, tip_speed})};
           }),
           py::arg("task"), py::arg("plan"), py::kw_only(), py::arg("time_step") = 5e-3,
           py::arg("angle") = 0.5, py::arg("rate") = 5.0, py::arg("torque_share") = 0.5,
           py::arg("tip_position") = 5e-3, py::arg("tip_speed") = 5e-2)
      .def_property_readonly(
          "steps", [](const TrackerOf& self) { return self.tracker.steps(); }, "int.")
      .def_property_readonly(
          "time_step", [](const TrackerOf& self) { return self.tracker.time_step(); },
          "float: s, a whole number of which makes the plan's duration.")
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
                optional(theta, "run(theta)", on->coordinates(), "rad"),
                optional(theta_dot, "run(theta_dot)", on->coordinates(), "rad/s"), feedback,
                time_step};
            const py::gil_scoped_release release;
            return plan::track(on, self.tracker, trial);
          },
          py::arg("arm") = nullptr, py::kw_only(), py::arg("theta") = py::none(),
          py::arg("theta_dot") = py::none(), py::arg("feedback") = true,
          py::arg("time_step") = 1e-3,
          R"(run($self, arm=None, *, theta=None, theta_dot=None, feedback=True, time_step=0.001)
--

A Replay of what the arm, or another one, makes of the plan.

Parameters
----------
arm : sinew.pcc.Arm, optional
    Whose masses and stiffnesses may be others.
theta, theta_dot : (coordinates,) rad, rad/s, optional
    Where it starts instead.
feedback : bool
    False: the plan's torques alone.
time_step : float
    s, of the simulation.)");
}

void bind_reach(py::module_& module) {
  module.def(
      "plan_sample_reach",
      [](const PccArm& arm, const py::object& torque_limits, int samples, std::uint64_t seed,
         const py::object& angle_limits) {
        const plan::Limits limits = reach_limits(*arm.arm, torque_limits, angle_limits);
        const plan::ReachMap map = plan::sample_reach(arm.arm, limits, samples, seed);
        py::dict result;
        result["tip"] = copy(map.tip);
        result["theta"] = copy(map.position);
        result["torque"] = copy(map.torque);
        return result;
      },
      py::arg("arm"), py::arg("torque_limits"), py::arg("samples") = 1000, py::arg("seed") = 1,
      py::kw_only(), py::arg("angle_limits") = py::none(),
      R"(plan_sample_reach(arm, torque_limits, samples=1000, seed=1, *, angle_limits=None)
--

Where the tip can rest: stable equilibria under random torques within the limits.

Parameters
----------
arm : sinew.pcc.Arm
torque_limits : (inputs,) or (2, inputs) N m
samples : int
    Of torques, each from two starts.
seed : int
angle_limits : (coordinates,) or (2, coordinates) rad, optional

Returns
-------
dict
    "tip" (found, 3) m, "theta" (found, coordinates) rad, "torque" (found, inputs) N m.)");
  module.def(
      "plan_nearest_reach",
      [](const PccArm& arm, const py::object& torque_limits, const py::object& goal, int starts,
         std::uint64_t seed, const py::object& angle_limits) {
        const plan::Limits limits = reach_limits(*arm.arm, torque_limits, angle_limits);
        const auto best = plan::nearest_reach(
            arm.arm, limits, to_vector3(goal, "nearest_reach(goal)", "m"), starts, seed);
        py::dict result;
        result["found"] = best.found;
        result["stable"] = best.stable;
        result["distance"] = best.distance;
        result["tip"] = copy(best.tip);
        result["theta"] = copy(best.position);
        result["torque"] = copy(best.torque);
        result["solved"] = best.solved;
        return result;
      },
      py::arg("arm"), py::arg("torque_limits"), py::arg("goal"), py::arg("starts") = 20,
      py::arg("seed") = 1, py::kw_only(), py::arg("angle_limits") = py::none(),
      R"(plan_nearest_reach(arm, torque_limits, goal, starts=20, seed=1, *, angle_limits=None)
--

The equilibrium, stable or not, whose tip is nearest to a goal (3,) m: the best of many starts.

Returns
-------
dict
    "found", "stable", "distance" m, "tip" (3,) m, "theta", "torque", and "solved", how many of the
    starts led to one.)");
  module.def(
      "plan_prove_out_of_reach",
      [](const PccArm& arm, const py::object& torque_limits, const py::object& goal,
         double tolerance, double angle, long max_boxes, const py::object& angle_limits) {
        const plan::Limits limits = reach_limits(*arm.arm, torque_limits, angle_limits);
        const Vector3 at = to_vector3(goal, "prove_out_of_reach(goal)", "m");
        const auto proof =
            plan::prove_out_of_reach(arm.arm, limits, at, {tolerance, angle, max_boxes});
        py::dict result;
        result["verdict"] = std::string(plan::verdict_name(proof.verdict));
        result["boxes"] = proof.boxes;
        result["smallest"] = proof.smallest;
        result["theta"] = copy(proof.position);
        return result;
      },
      py::arg("arm"), py::arg("torque_limits"), py::arg("goal"), py::kw_only(),
      py::arg("tolerance") = 0.02, py::arg("angle") = plan::ReachProofSettings{}.angle,
      py::arg("max_boxes") = plan::ReachProofSettings{}.max_boxes,
      py::arg("angle_limits") = py::none(),
      R"(plan_prove_out_of_reach(arm, torque_limits, goal, *, tolerance=0.02, angle=3.141592653589793, max_boxes=5000000, angle_limits=None)
--

Whether any equilibrium, stable or not, has its tip within `tolerance` (m, along each axis) of a
goal (3,) m, by branch and bound over the angles.

Parameters
----------
arm : sinew.pcc.Arm
    Of planar segments.
torque_limits : (inputs,) or (2, inputs) N m
goal : (3,) m
tolerance : float
angle : float
    rad, how far a segment may bend either way where `angle_limits` do not say.
max_boxes : int
angle_limits : (coordinates,) or (2, coordinates) rad, optional

Returns
-------
dict
    "verdict" ('out-of-reach', 'reachable' or 'undecided'), "boxes" looked at, "smallest" half-width
    needed in rad, "theta" of an equilibrium found there.)");
}

}  // namespace

void bind_plan(py::module_& module) {
  bind_obstacles(module);
  bind_plans(module);
  bind_task(module);
  bind_tracker(module);
  bind_reach(module);
  bind_brace(module);
}

}  // namespace sinew::python
