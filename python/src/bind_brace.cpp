// Binds bracing: objects, search and simulation.
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "sinew/plan/brace_run.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "pcc_arm.hpp"
#include "plan_limits.hpp"

namespace sinew::python {

namespace {

/// The class behind sinew.plan.Brace.
struct BraceOf {
  std::shared_ptr<const pcc::Arm> arm;
  plan::BraceTask task;
  plan::Brace brace;
};

/// Converts friction: the name of a pair of surfaces, a coefficient, or (minimum, maximum).
plan::FrictionRange friction_of(const py::object& value) {
  if (py::isinstance<py::str>(value)) return plan::friction_range(value.cast<std::string>());
  const Array array = to_array(value, "friction", "a number or (2,)");
  if (array.ndim() == 0) return {"given", array.data()[0], array.data()[0]};
  const VectorX both = to_vector(value, "friction", 2, "");
  return {"given", both[0], both[1]};
}

plan::TouchStiffness stiffness_of(const py::object& value) {
  if (value.is_none()) return plan::kRigid;
  const VectorX both = to_vector(value, "stiffness", 2, "N/m and N m/rad");
  return {both[0], both[1]};
}

void bind_objects(py::module_& module) {
  using plan::BraceObject;
  py::class_<BraceObject>(module, "PlanBraceObject",
                          "An object that an arm may lean against: plane(), sphere() or capsule().")
      .def_static(
          "plane",
          [](const py::object& point, const py::object& normal, const py::object& friction,
             const py::object& stiffness) {
            return BraceObject{constraint::Plane{to_vector3(point, "plane(point)", "m"),
                                                 to_vector3(normal, "plane(normal)", "")},
                               friction_of(friction), stiffness_of(stiffness)};
          },
          py::arg("point"), py::arg("normal"), py::kw_only(),
          py::arg("friction") = "silicone-on-steel", py::arg("stiffness") = py::none(),
          R"(plane(point, normal, *, friction='silicone-on-steel', stiffness=None)
--

A half space below a plane through a point (3,) m; the normal (3,) points out of the solid.

Parameters
----------
friction : str, float or (2,)
    Friction of the pair: 'silicone-on-steel' (0.6 to 0.9), 'coated-rigid' (0.05 to 0.20), a number, or a range.
stiffness : (2,), optional
    Radial N/m and torsional N m/rad; rigid by default.)")
      .def_static(
          "sphere",
          [](const py::object& centre, double radius, const py::object& friction,
             const py::object& stiffness) {
            return BraceObject{
                constraint::Sphere{to_vector3(centre, "sphere(centre)", "m"), radius},
                friction_of(friction), stiffness_of(stiffness)};
          },
          py::arg("centre"), py::arg("radius"), py::kw_only(),
          py::arg("friction") = "silicone-on-steel", py::arg("stiffness") = py::none(),
          R"(sphere(centre, radius, *, friction='silicone-on-steel', stiffness=None)
--

A ball with centre (3,) m and radius in m; see plane().)")
      .def_static(
          "capsule",
          [](const py::object& start, const py::object& end, double radius,
             const py::object& friction, const py::object& stiffness) {
            return BraceObject{constraint::Capsule{to_vector3(start, "capsule(start)", "m"),
                                                   to_vector3(end, "capsule(end)", "m"), radius},
                               friction_of(friction), stiffness_of(stiffness)};
          },
          py::arg("start"), py::arg("end"), py::arg("radius"), py::kw_only(),
          py::arg("friction") = "silicone-on-steel", py::arg("stiffness") = py::none(),
          R"(capsule(start, end, radius, *, friction='silicone-on-steel', stiffness=None)
--

A bar with round ends from (3,) to (3,) m, with a radius in m; see plane().)");
}

BraceOf find(const PccArm& arm, const py::object& goal, const py::object& torque_limits,
             const std::vector<plan::BraceObject>& objects, double tolerance,
             const py::object& angle_limits, const py::object& turn, const py::object& segments,
             const py::object& fractions, int along, int sides, double clearance, double hold_force,
             double hold_frequency, double friction_fraction, double min_force, double max_force,
             double stiffness_ratio, int starts, std::uint64_t seed) {
  plan::BraceTask task;
  task.goal = to_vector3(goal, "brace(goal)", "m");
  task.tolerance = tolerance;
  task.limits = to_limits(*arm.arm, torque_limits, angle_limits);
  task.objects = objects;
  if (!turn.is_none()) {
    const VectorX both = to_vector(turn, "brace(turn)", 2, "rad");
    task.turn_lower = both[0];
    task.turn_upper = both[1];
  }
  task.fractions = to_list(fractions, "brace(fractions)", "of a segment's length");
  task.along = along;
  task.sides = sides;
  task.clearance = clearance;
  task.hold_force = hold_force;
  task.hold_frequency = hold_frequency;
  task.friction_fraction = friction_fraction;
  task.min_force = min_force;
  task.max_force = max_force;
  task.stiffness_ratio = stiffness_ratio;
  task.starts = starts;
  task.seed = seed;
  const int only = segments.is_none() ? 0 : segments.cast<int>();
  const py::gil_scoped_release release;
  plan::Brace brace =
      segments.is_none() ? plan::find_brace(arm.arm, task) : plan::find_brace(arm.arm, task, only);
  return {arm.arm, task, std::move(brace)};
}

py::list conditions_of(const plan::Brace& brace) {
  py::list result;
  if (brace.object < 0) return result;
  for (const plan::BraceCondition& condition : brace.conditions) {
    py::dict entry;
    entry["name"] = std::string(condition.name);
    entry["verdict"] = std::string(plan::verdict_name(condition.verdict));
    entry["value"] = condition.value;
    entry["limit"] = condition.limit;
    result.append(entry);
  }
  return result;
}

plan::BraceRun carry_out(const BraceOf& self, bool braced, const py::object& friction, double force,
                         std::uint64_t seed, double hold, double time_step) {
  plan::BraceRunSettings settings;
  settings.time_step = time_step;
  settings.hold = hold;
  settings.disturbance.force = force;
  settings.disturbance.seed = seed;
  if (!friction.is_none()) settings.friction = to_number(friction, "run(friction)", "");
  const py::gil_scoped_release release;
  return braced ? plan::run_brace(self.arm, self.task, self.brace, settings)
                : plan::run_free(self.arm, self.task, settings);
}

void bind_found(py::module_& module) {
  py::class_<BraceOf>(module, "PlanBrace", "Result of brace().")
      .def_property_readonly(
          "status",
          [](const BraceOf& self) { return std::string(plan::status_name(self.brace.status)); },
          "str: 'braced', 'infeasible' or 'no-object-in-reach'.")
      .def_property_readonly(
          "found", [](const BraceOf& self) { return self.brace.found(); }, "bool: braced.")
      .def_property_readonly(
          "segments", [](const BraceOf& self) { return self.brace.segments; },
          "int: n, the number of the braced segment, counted from 1 at the base.")
      .def_property_readonly(
          "object", [](const BraceOf& self) { return self.brace.object; },
          "int: index of the object; -1: none.")
      .def_property_readonly(
          "fraction", [](const BraceOf& self) { return self.brace.point.fraction; },
          "float: position of the braced point, as a fraction of the segment's length.")
      .def_property_readonly(
          "theta", [](const BraceOf& self) { return reading(self.brace.position); },
          "(coordinates,) rad.")
      .def_property_readonly(
          "torque", [](const BraceOf& self) { return reading(self.brace.torque); },
          "(inputs,) N m.")
      .def_property_readonly(
          "turn", [](const BraceOf& self) { return self.brace.turn; },
          "float: rotation of the base, rad.")
      .def_property_readonly(
          "place", [](const BraceOf& self) { return reading(self.brace.place); },
          "(3,) m: the braced point, on the object.")
      .def_property_readonly(
          "normal", [](const BraceOf& self) { return reading(self.brace.normal); },
          "(3,): outward normal of the object.")
      .def_property_readonly(
          "force", [](const BraceOf& self) { return reading(self.brace.force); },
          "(3,) N: force on the arm.")
      .def_property_readonly(
          "normal_force", [](const BraceOf& self) { return self.brace.normal_force; }, "float: N.")
      .def_property_readonly(
          "friction_force", [](const BraceOf& self) { return self.brace.friction_force; },
          "float: N.")
      .def_property_readonly(
          "tip", [](const BraceOf& self) { return reading(self.brace.tip); }, "(3,) m.")
      .def_property_readonly(
          "tip_error", [](const BraceOf& self) { return self.brace.tip_error; }, "float: m.")
      .def_property_readonly(
          "gap", [](const BraceOf& self) { return self.brace.gap; },
          "float: gap of the braced point, m.")
      .def_property_readonly(
          "clearance", [](const BraceOf& self) { return self.brace.clearance; },
          "float: smallest gap of the other points of the skin, m.")
      .def_property_readonly(
          "balance", [](const BraceOf& self) { return self.brace.balance; },
          "float: largest component of the residual of the equilibrium, N m.")
      .def_property_readonly(
          "tip_compliance", [](const BraceOf& self) { return self.brace.tip_compliance; },
          "float: largest static compliance of the tip while the braced point sticks, m/N.")
      .def_property_readonly(
          "peak_compliance", [](const BraceOf& self) { return self.brace.peak_compliance; },
          "float: largest compliance of the tip up to hold_frequency while the braced point "
          "sticks, m/N.")
      .def_property_readonly(
          "hold_force", [](const BraceOf& self) { return self.brace.hold_force; },
          "float: force on the tip up to which the braced point sticks at the lower end of the "
          "friction range, N.")
      .def_property_readonly(
          "mobility", [](const BraceOf& self) { return self.brace.mobility; },
          "int: number of directions in which the tip can still move.")
      .def_property_readonly(
          "conditions", [](const BraceOf& self) { return conditions_of(self.brace); },
          "list of dict: 'name' (friction, stiffness, kinematic), 'verdict' (holds, uncertain, "
          "violated), 'value' and 'limit'; if no brace was found, for the closest equilibrium, or "
          "empty.")
      .def(
          "run", &carry_out, py::arg("braced") = true, py::kw_only(),
          py::arg("friction") = py::none(), py::arg("force") = plan::Disturbance{}.force,
          py::arg("seed") = 1, py::arg("hold") = plan::BraceRunSettings{}.hold,
          py::arg("time_step") = plan::BraceRunSettings{}.time_step,
          R"(run($self, braced=True, *, friction=None, force=0.01, seed=1, hold=4.0, time_step=0.001)
--

Simulates the brace: the arm moves to contact, presses, replans, moves to the goal, and is disturbed there. Returns a BraceRun.

Parameters
----------
braced : bool
    False: without objects, with the torques of the equilibrium closest to the goal.
friction : float, optional
    Coulomb's coefficient of every object; by default the lower end of its range.
force : float
    Root mean square of the disturbance along x, y and z, a sum of sines of 0.2 to 2 Hz, N.
seed : int
    Seed of the disturbance.
hold : float
    Duration of the disturbance, s.
time_step : float
    Step of backward Euler, s.)");
}

void bind_run(py::module_& module) {
  using plan::BraceRun;
  py::class_<BraceRun>(module, "PlanBraceRun", "Simulation of a brace, in equal steps.")
      .def_property_readonly(
          "status",
          [](const BraceRun& self) { return std::string(plan::status_name(self.status)); },
          "str: 'held', 'slipped', 'no-contact' or 'not-planned'.")
      .def_property_readonly(
          "times", [](const BraceRun& self) { return reading(self.times); }, "(steps + 1,) s.")
      .def_property_readonly(
          "theta", [](const BraceRun& self) { return reading(self.position); },
          "(steps + 1, coordinates) rad.")
      .def_property_readonly(
          "torque", [](const BraceRun& self) { return reading(self.torque); },
          "(steps + 1, inputs) N m.")
      .def_property_readonly(
          "tip", [](const BraceRun& self) { return reading(self.tip); }, "(steps + 1, 3) m.")
      .def_property_readonly(
          "normal_force", [](const BraceRun& self) { return reading(self.normal_force); },
          "(steps + 1,) N, at the braced point.")
      .def_property_readonly(
          "friction_force", [](const BraceRun& self) { return reading(self.friction_force); },
          "(steps + 1,) N, at the braced point.")
      .def_property_readonly(
          "contact_time", [](const BraceRun& self) { return self.contact_time; },
          "float: time of first contact, s; 0: never.")
      .def_property_readonly(
          "replan_time", [](const BraceRun& self) { return self.replan_time; },
          "float: time of the replanning, s.")
      .def_property_readonly(
          "disturbed_from", [](const BraceRun& self) { return self.disturbed_from; }, "float: s.")
      .def_property_readonly(
          "measured", [](const BraceRun& self) { return reading(self.measured); },
          "(coordinates,) rad, at the replanning.")
      .def_property_readonly(
          "hold_force", [](const BraceRun& self) { return self.after.hold_force; },
          "float: force on the tip up to which the braced point sticks in the new plan, N.")
      .def_property_readonly(
          "slips", [](const BraceRun& self) { return self.slips; },
          "int: number of disturbed steps in which the braced point did not stick.")
      .def_property_readonly(
          "cone_residual", [](const BraceRun& self) { return self.cone_residual; },
          "float: largest excess of friction over its limit in any step, N.")
      .def_property_readonly(
          "contact_residual", [](const BraceRun& self) { return self.contact_residual; },
          "float: largest relative residual of the contact laws in any step.")
      .def_property_readonly(
          "mean_error", [](const BraceRun& self) { return self.mean_error; },
          "float: mean distance of the tip from the goal during the disturbance, m.")
      .def_property_readonly(
          "offset", [](const BraceRun& self) { return self.offset; },
          "float: distance of the tip's mean position from the goal, m.")
      .def_property_readonly(
          "spread", [](const BraceRun& self) { return self.spread; },
          "float: root mean square distance of the tip from its mean position, m.");
}

}  // namespace

void bind_brace(py::module_& module) {
  bind_objects(module);
  bind_found(module);
  bind_run(module);
  const plan::BraceTask task;
  module.def(
      "plan_brace", &find, py::arg("arm"), py::arg("goal"), py::arg("torque_limits"),
      py::arg("objects"), py::kw_only(), py::arg("tolerance") = task.tolerance,
      py::arg("angle_limits") = py::none(), py::arg("turn") = py::none(),
      py::arg("segments") = py::none(), py::arg("fractions") = py::make_tuple(0.25, 0.5, 0.75, 1.0),
      py::arg("along") = task.along, py::arg("sides") = task.sides,
      py::arg("clearance") = task.clearance, py::arg("hold_force") = task.hold_force,
      py::arg("hold_frequency") = task.hold_frequency,
      py::arg("friction_fraction") = task.friction_fraction, py::arg("min_force") = task.min_force,
      py::arg("max_force") = task.max_force, py::arg("stiffness_ratio") = task.stiffness_ratio,
      py::arg("starts") = task.starts, py::arg("seed") = task.seed,
      R"(plan_brace(arm, goal, torque_limits, objects, *, tolerance=0.005, angle_limits=None, turn=None, segments=None, fractions=(0.25, 0.5, 0.75, 1.0), along=8, sides=0, clearance=0.001, hold_force=0.04, hold_frequency=2.0, friction_fraction=0.9, min_force=0.05, max_force=20.0, stiffness_ratio=10.0, starts=2, seed=1)
--

Finds where an arm can lean on its surroundings to hold its tip steadier. Returns a Brace.

Parameters
----------
arm : sinew.pcc.Arm
goal : (3,) m
    Goal of the tip.
torque_limits : (inputs,) or (2, inputs) N m
objects : list of BraceObject
    An empty list is infeasible.
tolerance : float
    m; the brace is planned with 40 % of it, the rest is for the motion there.
angle_limits : (coordinates,) or (2, coordinates) rad, optional
turn : (2,) rad, optional
    The base may turn about the arm's axis by an angle between these.
segments : int, optional
    Segment of the braced point, counted from 1; by default the first one that can brace.
fractions : sequence of float
    Candidates for the braced point, as fractions of a segment's length.
along : int
    Number of equal parts of a segment at whose ends the skin has points ...
sides : int
    ... at this many positions around the section; 0: 2, or 4 for spatial arms.
clearance : float
    Distance of the other points of the skin from the objects, m.
hold_force, hold_frequency : float
    N and Hz: the braced point must stick under any sum of sinusoidal forces on the tip up to this
    frequency whose amplitudes add up to this force.
friction_fraction : float
    Fraction of the lowest friction that the brace may use.
min_force, max_force : float
    Limits of the normal force, N.
stiffness_ratio : float
    Required stiffness of an object relative to that of the arm (1 N/mm, 0.2 N m/rad).
starts : int
    Number of starts of the search for each candidate.
seed : int

Raises
------
Error
    out-of-range, contradictory-limits, not-finite, wrong-shape, unknown-choice.)");
}

}  // namespace sinew::python
