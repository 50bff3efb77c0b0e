#include <fmt/format.h>

#include "sinew/sim/simulation.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "session.hpp"

namespace sinew::python {

namespace {

using run::StepReport;
using statics::StaticReport;

py::dict times_of(const StepReport& report) {
  py::dict times;
  for (std::size_t i = 0; i < world::kStageCount; ++i) {
    times[world::kStageNames[i]] = report.times.seconds[i];
  }
  times["total"] = report.times.total;
  return times;
}

void bind_step_report(py::module_& module) {
  py::class_<StepReport>(module, "StepReport", "Report of the last step.")
      .def_property_readonly(
          "status", [](const StepReport& self) { return run::step_status_name(self.status); },
          "str: 'solved'; 'limits-conflict' if limits contradict each other (the step takes the "
          "smallest violation); or a flag, for which step() and run() issue a warning: "
          "'command-not-reached', 'cavitates', 'cut-back', 'gaining-energy', 'after-failure'; or a "
          "failure, for which they raise RunError unless told to keep going: 'not-in-equilibrium', "
          "'unphysical'.")
      .def_property_readonly(
          "failed", [](const StepReport& self) { return run::is_failure(self.status); },
          "bool: whether the status is a failure: the state of the step solves nothing.")
      .def_readonly("snapped", &StepReport::snapped,
                    "bool: whether a quasi-static step left the branch of equilibria on which it "
                    "began, as where an arch snaps through. No flag.")
      .def_property_readonly(
          "flagged", [](const StepReport& self) { return run::is_flagged(self.status); },
          "bool: whether the status is a flag: the results of the step are not reliable.")
      .def_readonly("residual", &StepReport::residual,
                    "float: norm of the unbalanced forces at the end of the step (N).")
      .def_readonly(
          "energy_gained", &StepReport::energy_gained,
          "float: energy (J) of a dynamic robot beyond what was put in since the start; negative "
          "if the integrator damps.")
      .def_readonly("relative_residual", &StepReport::relative_residual,
                    "float: residual divided by the sum of the force norms.")
      .def_readonly(
          "distance", &StepReport::distance,
          "float: bound (m) of the distance between this state and the solution of the step's "
          "equation, for a quasi-static step the equilibrium, under the same commands: the largest "
          "difference of any coordinate. An estimate that held in 99 % of the steps of the test in "
          "docs/solver.md. inf if no bound was found; nan if none was sought, in flagged steps and "
          "in dynamic steps with one iteration.")
      .def_readonly("following", &StepReport::following,
                    "bool: whether the step could end by the rule of `equilibrium: following`.")
      .def_readonly("violation", &StepReport::violation,
                    "float: violation of the actuators' laws at the end (m).")
      .def_readonly(
          "contact_residual", &StepReport::contact_residual,
          "float: largest residual of the contact laws at any point, relative to the largest "
          "contact force; 0 without contacts.")
      .def_readonly(
          "contact_signorini", &StepReport::contact_signorini,
          "float: largest penetration of a point, or gap across which a force acts, in the "
          "solution of the contact laws (m).")
      .def_readonly(
          "contact_coulomb", &StepReport::contact_coulomb,
          "float: largest motion along a surface that friction should have prevented, or that is "
          "not opposite to its friction (m).")
      .def_readonly("contact_complementarity", &StepReport::contact_complementarity,
                    "float: largest product of gap and normal force of a point (J).")
      .def_readonly(
          "contact_aggregation", &StepReport::contact_aggregation,
          "float: for contacts with `aggregate`, the estimated difference of their forces from "
          "those of single points, relative to the sum of the zones' forces; otherwise 0. For "
          "friction it starts at 0 when the run begins or a state is loaded.")
      .def_readonly("iterations", &StepReport::iterations,
                    "int: number of linear solutions in the step.")
      .def_readonly(
          "substeps", &StepReport::substeps,
          "int: number of parts of the step; more than 1 if the whole step found no solution, or "
          "in adaptive steps.")
      .def_readonly("retries", &StepReport::retries,
                    "int: number of parts of the step that failed and were made again, shorter or "
                    "with another choice of a controller.")
      .def_readonly(
          "impacts", &StepReport::impacts,
          "int: number of instants of impact in the step; only with the integrator 'event-driven'.")
      .def_readonly(
          "choice_held", &StepReport::choice_held,
          "bool: whether a controller's choice of efforts did not settle in the step and was held. "
          "Other efforts may then serve about as well.")
      .def_readonly("scale", &StepReport::scale,
                    "float: 1, or less if the motion was cut back to keep elements from inverting.")
      .def_readonly("smallest_volume_ratio", &StepReport::smallest_volume_ratio,
                    "float: smallest det F of all elements at the end of the step.")
      .def_property_readonly("times", &times_of,
                             "dict: seconds in 'detection' (of contact), 'assembly', 'rows', "
                             "'factorisation', 'law', 'correction' and 'total'.")
      .def("__repr__", [](const StepReport& self) {
        return fmt::format("<StepReport {}, residual {:.3g} N, {} iteration(s), {:.3g} ms>",
                           run::step_status_name(self.status), self.residual, self.iterations,
                           1e3 * self.times.total);
      });
}

void bind_static_report(py::module_& module) {
  py::class_<StaticReport>(module, "StaticReport", "Report of solve_static().")
      .def_property_readonly(
          "status",
          [](const StaticReport& self) { return std::string(newton_status_name(self.status)); },
          "str: 'converged'.")
      .def_readonly("residual", &StaticReport::residual,
                    "float: norm of the remaining unbalanced forces (N).")
      .def_readonly("relative_residual", &StaticReport::relative_residual,
                    "float: residual divided by the sum of the force norms.")
      .def_readonly("violation", &StaticReport::violation,
                    "float: violation of the actuators' laws (m).")
      .def_readonly("iterations", &StaticReport::iterations,
                    "int: Newton iterations over all load steps.")
      .def_readonly("load_steps", &StaticReport::load_steps, "int: number of load steps.")
      .def_readonly(
          "relaxation_steps", &StaticReport::relaxation_steps,
          "int: number of steps of overdamped motion, from the last load step or from an unstable "
          "equilibrium.")
      .def_readonly(
          "negative_pivots", &StaticReport::negative_pivots,
          "int: number of negative eigenvalues of the exact tangent on the motions that commanded "
          "motions, drives and contacts leave free. For pressure on open surfaces, whose tangent "
          "is not symmetric, those of the symmetric part.")
      .def_readonly(
          "stable", &StaticReport::stable,
          "bool: whether small disturbances decay: no negative pivots, or, without a potential, "
          "overdamped motion returned from a disturbance.")
      .def("__repr__", [](const StaticReport& self) {
        return fmt::format("<StaticReport {} in {} iterations, residual {:.3g} N, {}>",
                           newton_status_name(self.status), self.iterations, self.residual,
                           self.stable ? "stable" : "unstable");
      });
}

py::list to_arrays(const std::vector<std::vector<Points>>& fields) {
  py::list result;
  for (const std::vector<Points>& rows : fields) {
    const auto count = static_cast<py::ssize_t>(rows.size());
    const py::ssize_t nodes = rows.empty() ? 0 : rows.front().rows();
    Array array({count, nodes, py::ssize_t{3}});
    for (py::ssize_t row = 0; row < count; ++row) {
      const Points& points = rows[static_cast<std::size_t>(row)];
      std::copy_n(points.data(), points.size(), array.mutable_data(row, 0, 0));
    }
    result.append(array);
  }
  return result;
}

void bind_linearisation(py::module_& module) {
  py::class_<sim::Linearisation>(
      module, "Linearisation",
      "Linearisation near one state, delta = delta_free + W @ effort: motions of the rows as a "
      "function of their efforts. Rows are actuators, then effectors' directions, as named in "
      "`rows`.")
      .def_readonly("rows", &sim::Linearisation::rows, "list of str: name of every row.")
      .def_property_readonly(
          "W", [](const sim::Linearisation& self) { return reading(self.compliance); },
          "(rows, rows) ndarray: compliance, m/N (rad/N in rows of orientations). Symmetric.")
      .def_property_readonly(
          "delta", [](const sim::Linearisation& self) { return reading(self.delta); },
          "(rows,) ndarray: present motions of the rows: pull of a cable, coordinate of an "
          "effector (m).")
      .def_property_readonly(
          "delta_free", [](const sim::Linearisation& self) { return reading(self.delta_free); },
          "(rows,) ndarray: motions without efforts in the linearisation (m).")
      .def_property_readonly(
          "effort", [](const sim::Linearisation& self) { return reading(self.effort); },
          "(rows,) ndarray: present efforts (N); 0 for effectors.")
      .def_readonly("residual", &sim::Linearisation::residual,
                    "float: norm of the unbalanced forces at this state (N).")
      .def_readonly(
          "negative_pivots", &sim::Linearisation::negative_pivots,
          "int: number of negative eigenvalues of the matrix; 0 for a stable equilibrium.")
      .def_property_readonly(
          "fields", [](const sim::Linearisation& self) { return to_arrays(self.fields); },
          "list of (rows, n, 3) ndarray, one for each body: motion of all nodes for a unit effort "
          "of each row, m/N; by reciprocity also the motion of the row for a unit force on each "
          "node. (0, 0, 3) for bodies without finite elements. Empty unless requested.");
}

}  // namespace

void bind_reports(py::module_& module) {
  bind_step_report(module);
  bind_static_report(module);
  bind_linearisation(module);
}

}  // namespace sinew::python
