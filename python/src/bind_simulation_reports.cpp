// Binds reports and observables of a simulation.
#include <string>

#include "sinew/model/model.hpp"
#include "sinew/run/state.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

#include "errors.hpp"
#include "simulation_type.hpp"

namespace sinew::python {

namespace {

std::string to_yaml(const Session& self) {
  scene::Node tree = self.robot().robot.description.tree;
  scene::resolve_paths(tree, self.robot().folder);
  return scene::to_yaml(tree);
}

py::dict ledger(Session& self) {
  const Session::Use use(self);
  sim::Observables& observables = self.observables();
  observables.refresh();
  py::dict result;
  for (std::size_t k = 0; k < observables.list().size(); ++k) {
    const run::Observable& one = observables.list()[k];
    const bool counts =
        one.kind == run::ObservableKind::energy || one.kind == run::ObservableKind::ledger;
    if (counts) result[one.name.c_str()] = observables.number(k);
  }
  return result;
}

py::list notices(const Session& self) {
  py::list result;
  for (const Notice& notice : self.robot().robot.notices) {
    result.append(to_python(notice));
  }
  return result;
}

template <typename Get>
auto guarded(Get get) {
  return [get](const Session& self) {
    const Session::Use use(self);
    return get(self.simulation());
  };
}

void bind_progress(SimulationType& type) {
  type.def_property_readonly("time", &Session::time, "float: s.")
      .def_property_readonly("steps", &Session::steps, "int: number of steps since the start.")
      .def_property_readonly(
          "time_step", [](const Session& self) { return self.model().step().time_step; },
          "float: s.")
      .def_property_readonly(
          "threads", [](const Session& self) { return self.simulation().threads(); },
          "int: number of threads per step.")
      .def_property_readonly("busy", &Session::busy,
                             "bool: whether another thread is making a step.")
      .def_property_readonly("report", guarded([](const sim::Simulation& s) { return s.report(); }),
                             "StepReport: report of the last step.")
      .def_property_readonly(
          "state_hash", guarded([](const sim::Simulation& s) { return s.state().hash(); }),
          "int: hash of positions, velocities, efforts and drives; equal runs have equal hashes, "
          "bit for bit.");
}

void bind_balance(SimulationType& type) {
  type.def_property_readonly(
          "ledger", &ledger,
          "dict: energies in J, as in run.csv. Present sums over all bodies: `strain_energy`, "
          "`kinetic_energy` and `gravity_energy` (relative to rest). Since the start: "
          "`actuator_work`; `outside_work` of loads, external forces, moving bases and surfaces; "
          "`dissipation` by damping, drag, and the friction of cables and contacts; "
          "`numerical_loss`, work minus dissipation minus energy gain: the loss of the integrator, "
          "and what solve_static() and follow_path() put in.")
      .def_property_readonly(
          "memory", guarded([](const sim::Simulation& s) { return s.bytes(); }),
          "int: memory of this simulation without the shared model, bytes. Only simulations in a "
          "step hold a factor; between steps it is not counted.");
}

void bind_scene(SimulationType& type) {
  type.def_property_readonly(
          "name", [](const Session& self) { return self.robot().robot.description.name; },
          "str: name of the scene.")
      .def_property_readonly("notices", &notices,
                             "list of Notice: warnings and remarks on the scene.")
      .def("to_yaml", &to_yaml,
           R"(to_yaml($self)
--

The scene as YAML, with overrides and absolute paths. When loaded again, it gives the same robot.

Returns
-------
str
)");
}

}  // namespace

void bind_simulation_reports(SimulationType& type) {
  bind_progress(type);
  bind_balance(type);
  bind_scene(type);
}

}  // namespace sinew::python
