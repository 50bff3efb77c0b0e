// What a simulation tells of itself.
#include <string>

#include "sinew/scene/scene.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state.hpp"

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
    const sim::Observable& one = observables.list()[k];
    const bool counts =
        one.kind == sim::ObservableKind::energy || one.kind == sim::ObservableKind::ledger;
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
      .def_property_readonly("steps", &Session::steps, "int: steps taken since the start.")
      .def_property_readonly(
          "time_step", [](const Session& self) { return self.model().step().time_step; },
          "float: s.")
      .def_property_readonly(
          "threads", [](const Session& self) { return self.simulation().threads(); },
          "int: threads inside a step.")
      .def_property_readonly("busy", &Session::busy,
                             "bool: whether a step is under way in some thread.")
      .def_property_readonly("report", guarded([](const sim::Simulation& s) { return s.report(); }),
                             "StepReport: what the last step did.")
      .def_property_readonly(
          "state_hash", guarded([](const sim::Simulation& s) { return s.state().hash(); }),
          "int: of positions, velocities, efforts and drives; equal runs have equal hashes, bit "
          "for bit.");
}

void bind_balance(SimulationType& type) {
  type.def_property_readonly(
          "ledger", &ledger,
          "dict: J, as in run.csv. Of all bodies now: `strain_energy`, `kinetic_energy` and "
          "`gravity_energy` (from the height at rest). Since the start: `actuator_work`; "
          "`outside_work` of loads and outside forces; `dissipation` by damping, drag, and the "
          "friction of cables and contacts; `numerical_loss`, work less dissipation less what the "
          "energies gained: the integrator's, and what solve_static(), follow_path() and a moved "
          "base put in.")
      .def_property_readonly("memory", guarded([](const sim::Simulation& s) { return s.bytes(); }),
                             "int: bytes of this simulation without the model that it shares. Of "
                             "many simulations of a model only those that are in a step hold a "
                             "factor; between steps it is not counted.");
}

void bind_scene(SimulationType& type) {
  type.def_property_readonly(
          "name", [](const Session& self) { return self.robot().robot.description.name; },
          "str: of the scene.")
      .def_property_readonly(
          "notices", &notices,
          "list of Notice: what a user should know of the scene, warnings and remarks.")
      .def("to_yaml", &to_yaml,
           R"(to_yaml($self)
--

The scene as YAML, overrides included and paths absolute. Loaded again it gives the same robot.

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
