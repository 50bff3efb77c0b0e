#include <fmt/format.h>

#include "sinew/constraint/probe.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state.hpp"

#include "arrays.hpp"
#include "bindings.hpp"
#include "errors.hpp"
#include "session.hpp"
#include "tree.hpp"

namespace sinew::python {

namespace {

namespace fs = std::filesystem;

std::shared_ptr<Session> build(scene::Node tree, const std::vector<std::string>& overrides,
                               const fs::path& folder, const std::string& name,
                               const std::optional<int>& threads) {
  const py::gil_scoped_release release;
  for (const std::string& assignment : overrides) scene::apply_override(tree, assignment);
  auto description = scene::parse_scene_tree(std::move(tree), folder);
  description.name = name;
  if (threads) description.solver.threads = *threads;
  auto robot = std::make_shared<const LoadedRobot>(
      LoadedRobot{scene::build(std::move(description)), folder});
  return std::make_shared<Session>(robot, robot->robot.threads());
}

std::shared_ptr<Session> load_file(const std::string& path,
                                   const std::vector<std::string>& overrides,
                                   const std::optional<int>& threads) {
  return build(scene::read_yaml(path), overrides, fs::path(path).parent_path(),
               fs::path(path).stem().string(), threads);
}

std::shared_ptr<Session> load_text(const std::string& text,
                                   const std::vector<std::string>& overrides,
                                   const std::string& folder, const std::string& name,
                                   const std::optional<int>& threads) {
  return build(scene::parse_yaml(text, name), overrides, folder, name, threads);
}

std::shared_ptr<Session> load_tree(const py::object& tree,
                                   const std::vector<std::string>& overrides,
                                   const std::string& folder, const std::string& name,
                                   const std::optional<int>& threads) {
  return build(to_tree(tree), overrides, folder, name, threads);
}

std::string to_yaml(const Session& self) {
  scene::Node tree = self.robot().robot.description.tree;
  scene::resolve_paths(tree, self.robot().folder);
  return scene::to_yaml(tree);
}

py::dict all_actuators(const std::shared_ptr<Session>& self) {
  py::dict result;
  int index = 0;
  for (const auto& actuator : self->model().actuators()) {
    result[actuator.name.c_str()] = Actuator{{self, index++}};
  }
  return result;
}

py::dict all_effectors(const std::shared_ptr<Session>& self) {
  py::dict result;
  int index = 0;
  for (const auto& effector : self->model().effectors()) {
    result[effector.name.c_str()] = Effector{{self, index++}};
  }
  return result;
}

py::dict all_probes(const std::shared_ptr<Session>& self) {
  py::dict result;
  int index = 0;
  for (const auto& probe : self->model().probes()) {
    result[probe.name().c_str()] = Probe{{self, index++}};
  }
  return result;
}

py::dict all_masses(const std::shared_ptr<Session>& self) {
  py::dict result;
  int index = 0;
  for (const auto& mass : self->model().masses()) {
    result[mass.name.c_str()] = PointMass{{self, index++}};
  }
  return result;
}

py::dict all_contacts(const std::shared_ptr<Session>& self) {
  py::dict result;
  int index = 0;
  for (const auto& contact : self->model().contacts()) {
    result[contact.name.c_str()] = Contact{{self, index++}};
  }
  return result;
}

py::dict all_joints(const std::shared_ptr<Session>& self) {
  py::dict result;
  int index = 0;
  for (const auto& weld : self->model().joints()) {
    result[weld.name.c_str()] = Joint{{self, index++}};
  }
  return result;
}

py::dict all_bodies(const std::shared_ptr<Session>& self) {
  py::dict result;
  int index = 0;
  for (const auto& body : self->model().bodies()) {
    result[body.name().c_str()] = Body{{self, index++}};
  }
  return result;
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

sim::LinearisationChoice choice(const std::string& tangent, bool geometric_stiffness,
                                bool statics) {
  return {to_tangent(tangent, "linearise(tangent)"), geometric_stiffness, statics};
}

sim::StabilityChoice stability_choice(const std::string& name) {
  if (name == "stable") return sim::StabilityChoice::stable;
  if (name == "any") return sim::StabilityChoice::any;
  throw Error(ErrorKind::unknown_choice, {.item = "solve_static(stability)"},
              fmt::format("there is no stability '{}'", name), "use 'stable' or 'any'");
}

sim::StaticReport solve_static(Session& self, double tolerance, int max_iterations,
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

template <typename Get>
auto guarded(Get get) {
  return [get](const Session& self) {
    const Session::Use use(self);
    return get(self.simulation());
  };
}

using Type = py::class_<Session, std::shared_ptr<Session>>;

void bind_parts(Type& type) {
  type.def(
          "actuator",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return Actuator{{self, self->model().actuator_index(name)}};
          },
          py::arg("name"),
          R"(actuator($self, name)
--

An actuator by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def(
          "effector",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return Effector{{self, self->model().effector_index(name)}};
          },
          py::arg("name"),
          R"(effector($self, name)
--

An effector by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def(
          "load",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return Load{{self, self->model().load_index(name)}};
          },
          py::arg("name"),
          R"(load($self, name)
--

A load by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def(
          "mass",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return PointMass{{self, self->model().mass_index(name)}};
          },
          py::arg("name"),
          R"(mass($self, name)
--

A mass that hangs on a body, by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def(
          "follow_path",
          [](Session& self, double first_step, double largest_step, double tolerance,
             int max_points) {
            sim::Simulation& simulation = self.simulation();
            const auto& effectors = simulation.model().effectors();
            std::vector<std::vector<Vector3>> values(effectors.size());
            const auto path =
                self.follow_path({first_step, largest_step, tolerance, max_points}, [&] {
                  for (std::size_t i = 0; i < effectors.size(); ++i) {
                    values[i].push_back(simulation.effector_value(static_cast<int>(i)));
                  }
                });
            VectorX load_fraction(static_cast<Eigen::Index>(path.size())),
                unstable(load_fraction.size());
            for (Eigen::Index k = 0; k < load_fraction.size(); ++k) {
              load_fraction[k] = path[static_cast<std::size_t>(k)].load_fraction;
              unstable[k] = path[static_cast<std::size_t>(k)].negative_pivots;
            }
            py::dict result;
            result["load_fraction"] = copy(load_fraction);
            result["negative_pivots"] = copy(unstable);
            for (std::size_t i = 0; i < effectors.size(); ++i) {
              Points points(load_fraction.size(), 3);
              for (Eigen::Index k = 0; k < load_fraction.size(); ++k) {
                points.row(k) = values[i][static_cast<std::size_t>(k)].transpose();
              }
              result[py::str(effectors[i].name)] = copy(points);
            }
            return result;
          },
          py::kw_only(), py::arg("first_step") = 0.01, py::arg("largest_step") = 0.05,
          py::arg("tolerance") = 1e-9, py::arg("max_points") = 500,
          R"(follow_path($self, *, first_step=0.01, largest_step=0.05, tolerance=1e-09, max_points=500)
--

Equilibria while loads and commanded efforts grow in proportion, from what acted last (nothing, at
the start) to what they are told to be now: by arc length, so through limit points and back, where
solve_static() would jump or fail. The last one lies at the full load or just beyond it. Friction of
contacts is that of one slow motion from each point to the next.

Parameters
----------
first_step, largest_step : float
    Largest motion of any coordinate in a step, as a part of the robot's size.
tolerance : float
    Residual relative to the loads.
max_points : int

Returns
-------
dict
    'load_fraction' (k,): part of the load; 'negative_pivots' (k,): directions in which the point is
    unstable; and by its name the value (k, 3) of every effector.

Raises
------
Error
    bad-argument where an actuator is told a motion or has a drive, or a cable has friction;
    not-in-this-version beside curved surfaces with friction, and where contacts alone hold a body.
RunError
    not-converged; the state is then that of the start.
)")
      .def_property_readonly(
          "ledger", &ledger,
          "dict: J, as in run.csv. Of all bodies now: `strain_energy`, `kinetic_energy` and "
          "`gravity_energy` (from the height at rest). Since the start: `actuator_work`; "
          "`outside_work` of loads and outside forces; `dissipation` by damping, drag, and the "
          "friction of cables and contacts; `numerical_loss`, work less dissipation less what the "
          "energies gained: the integrator's, and what solve_static(), follow_path() and a moved "
          "base put in.")
      .def(
          "probe",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return Probe{{self, self->model().probe_index(name)}};
          },
          py::arg("name"),
          R"(probe($self, name)
--

A probe by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def(
          "contact",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return Contact{{self, self->model().contact_index(name)}};
          },
          py::arg("name"),
          R"(contact($self, name)
--

A contact by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def(
          "joint",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return Joint{{self, self->model().joint_index(name)}};
          },
          py::arg("name"),
          R"(joint($self, name)
--

A joint by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def(
          "body",
          [](const std::shared_ptr<Session>& self, const std::string& name) {
            return Body{{self, self->model().body_index(name)}};
          },
          py::arg("name"),
          R"(body($self, name)
--

A body by its name. Raises Error (unknown-name) with a suggestion.
)")
      .def_property_readonly("actuators", &all_actuators,
                             "dict: all actuators by name, in the scene's order.")
      .def_property_readonly("effectors", &all_effectors,
                             "dict: all effectors by name, in the scene's order.")
      .def_property_readonly("probes", &all_probes,
                             "dict: all probes by name, in the scene's order.")
      .def_property_readonly("masses", &all_masses,
                             "dict: all masses that hang on bodies by name, body by body.")
      .def_property_readonly("contacts", &all_contacts,
                             "dict: all contacts by name, in the scene's order.")
      .def_property_readonly("joints", &all_joints,
                             "dict: all joints by name, in the scene's order.")
      .def_property_readonly("bodies", &all_bodies,
                             "dict: all bodies by name, in the scene's order.");
}

void bind_stepping(Type& type) {
  type.def(
          "step", [](Session& self, const py::object& n) { self.advance(to_count(n, "step(n)")); },
          py::arg("n") = 1,
          R"(step($self, n=1)
--

Advances n time steps. Other Python threads run meanwhile; Ctrl-C ends it between steps.

Parameters
----------
n : int
    >= 0.

Raises
------
RunError
    diverged, inverted-in-run, singular-matrix or not-converged, with the step, the body and the
    likely cause; the state is then that before the step that failed.
)")
      .def(
          "solve_static", &solve_static, py::kw_only(), py::arg("tolerance") = 1e-10,
          py::arg("max_iterations") = 60, py::arg("max_load_steps") = 256,
          py::arg("max_relaxation_steps") = 200, py::arg("stability") = "stable",
          R"(solve_static($self, *, tolerance=1e-10, max_iterations=60, max_load_steps=256, max_relaxation_steps=200, stability='stable')
--

A stable static equilibrium at the present inputs, by Newton with the exact tangent and the cables'
geometric stiffness.

Limits on rates are lifted and the actuators of a controller hold their efforts. Velocities become
zero; time stands still. Where Newton fails in one go, the load comes in parts; where that ends
before the full load, the robot moves on by overdamped motion. An unstable equilibrium (a column
straight beyond its buckling load) is disturbed along the direction of its lowest curvature and left
for a stable one.

Parameters
----------
tolerance : float
    Residual relative to the loads, and violation of the actuators' law relative to the size.
max_iterations : int
    Of Newton in one load step.
max_load_steps : int
    Where one go fails, the load comes in parts, the least of which is its inverse.
max_relaxation_steps : int
    Steps of overdamped motion.
stability : str
    'stable', or 'any' for the equilibrium that Newton finds, stable or not: to follow an unstable
    branch. See StaticReport.negative_pivots.

Returns
-------
StaticReport

Raises
------
RunError
    not-converged when no equilibrium is found, or none that is stable; the state is then as before.
)")
      .def("run", &run, py::arg("duration") = py::none(), py::kw_only(),
           py::arg("record") = py::none(), py::arg("every") = 1, py::arg("progress") = py::none(),
           R"(run($self, duration=None, *, record=None, every=1, progress=None)
--

Steps for a while and returns what happened, the start included.

Parameters
----------
duration : float, optional
    s; by default the scene's, or the length of its signals and targets.
record : list of str, optional
    Which keys to return beside 'time'; by default all but those named "on request" below.
every : int
    Steps between records; the last step is always recorded.
progress : callable, optional
    Called with (steps done, all steps) about ten times a second. It may read the simulation and
    command it.

Returns
-------
dict of ndarray
    'time' (k,) s; for every actuator effort and motion, 'NAME.tension' (k,) N and
    'NAME.displacement' (k,) m, and what is commanded of them, 'NAME.tension_command' and
    'NAME.displacement_command', NaN while another quantity is (a controller commands efforts); for
    every effector 'NAME.position' (k, 3) m or 'NAME.rotation' (k, 3) rad; for every probe
    'NAME.value'; for every contact 'NAME.force' (k, 3) N, 'NAME.normal_force', 'NAME.gap' and so
    on; 'residual' (k,) N and other numbers of the step's report; 'status' (k,) of str; with a
    controller 'NAME.target' (k, 3), 'NAME.error' (k,), 'error' (k,) m and 'controller' (k,) of str.
    On request for every body 'NAME.positions' (k, n, 3) m and 'NAME.velocities'; for the n points
    of a contact 'NAME.points.gap' (k, n) m, 'NAME.points.normal_force' N and so on; 'strain_energy',
    'actuator_work' and so on (k,) J, work from the first record on; 'time.step' (k,) s.

Raises
------
RunError
    As step(). What was recorded until then is in the exception's `recorded`, as it is in that of
    a KeyboardInterrupt.
)");
}

void bind_state(Type& type) {
  type.def("reset", &Session::reset,
           R"(reset($self)
--

Back to the start, bit for bit: state, time, and the scene's commands; external forces become zero,
and a base that move_base() moved is back.
Controllers stay attached and keep their targets.
)")
      .def("clone", &Session::clone,
           R"(clone($self)
--

A further simulation of the same robot, at the same state, with the same commands and controller.

It shares the model (mesh, symbolic factorisation) and costs `memory` bytes. The two may run side
by side in threads.

Returns
-------
Simulation
)")
      .def("__copy__", &Session::clone, "A clone().")
      .def(
          "__deepcopy__", [](const Session& self, const py::dict&) { return self.clone(); },
          "A clone(), which shares the model.")
      .def(
          "__reduce_ex__",
          [](const Session&, const py::object&) -> py::object {
            throw py::type_error(
                "a sinew.Simulation does not pickle; send sim.to_yaml() and sim.state(), load the "
                "text elsewhere with sinew.loads(text), and restore(state) there");
          },
          "Raises TypeError, which says what to pickle instead.")
      .def("state", &Session::state,
           R"(state($self)
--

Everything that decides, together with the inputs, how the run goes on.

Returns
-------
sinew.State
    A value: it compares, copies and pickles, and stays what it is while the simulation goes on.
)")
      .def("restore", &Session::restore, py::arg("state"),
           R"(restore($self, state)
--

Takes up a state; the run then goes on bit for bit as the one that it came from.

An attached controller takes up its memory where the state has it, and begins anew otherwise.
Commands, factors of loads, external forces and tethers stay as they are.

Parameters
----------
state : sinew.State
    Of this simulation, a clone, or another one of the same robot.

Raises
------
Error
    state-mismatch for a state of another robot, naming what differs; the state is then as before.
)")
      .def("save_state", &Session::save_state, py::arg("path"),
           R"(save_state($self, path)
--

Writes the state: positions, velocities, bases, efforts, drives, time. Commands and external forces
are inputs and are not part of it.

Parameters
----------
path : path-like
    The file appears whole or not at all.

Raises
------
Error
    file-unwritable.
)")
      .def("load_state", &Session::load_state, py::arg("path"),
           R"(load_state($self, path)
--

Puts back what save_state() wrote for the same robot; commands stay as they are.

Parameters
----------
path : path-like

Raises
------
Error
    file-not-found, state-corrupt, state-version, or state-mismatch for a file of another robot;
    the state is then as before.
)")
      .def_property_readonly(
          "state_hash", guarded([](const sim::Simulation& s) { return s.state().hash(); }),
          "int: of positions, velocities, efforts and drives; equal runs have equal hashes, bit "
          "for bit.")
      .def_property_readonly("time", &Session::time, "float: s.")
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
      .def_property_readonly("memory", guarded([](const sim::Simulation& s) { return s.bytes(); }),
                             "int: bytes of this simulation without the model that it shares.")
      .def_property_readonly(
          "name", [](const Session& self) { return self.robot().robot.description.name; },
          "str: of the scene.")
      .def_property_readonly(
          "notices",
          [](const Session& self) {
            py::list result;
            for (const Notice& notice : self.robot().robot.notices) {
              result.append(to_python(notice));
            }
            return result;
          },
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

void bind_linearisation(Type& type) {
  type.def_property_readonly(
          "rows", [](const Session& self) { return sim::row_names(self.model()); },
          "list of str: the rows of H and W in the scene's order: actuators by name, effectors as "
          "'tip.x', contacts as 'floor point 3 normal'. Joints have none: they are taken out.")
      .def(
          "linearise",
          [](Session& self, const std::string& tangent, bool geometric_stiffness, bool statics) {
            return self.linearise(choice(tangent, geometric_stiffness, statics));
          },
          py::kw_only(), py::arg("tangent") = "exact", py::arg("geometric_stiffness") = true,
          py::arg("statics") = true,
          R"(linearise($self, *, tangent='exact', geometric_stiffness=True, statics=True)
--

How motions follow from efforts near the present state, which is not changed.

Parameters
----------
tangent : {'exact', 'projected', 'rotated'}
    The elements' stiffness: the derivative of the forces, the same made positive semi-definite
    element by element, or R K0 R^T with rotations held fixed.
geometric_stiffness : bool
    Whether loaded cables add theirs.
statics : bool
    W of equilibrium, H K^-1 H^T; False: of the scene's integrator and time step.

Returns
-------
Linearisation
    `W`, `delta`, `delta_free`, `effort`, `rows`, `residual`, `negative_pivots`.

Raises
------
RunError
    singular-matrix.
)")
      .def(
          "compliance",
          [](Session& self, const std::string& tangent, bool geometric_stiffness, bool statics) {
            return copy(self.linearise(choice(tangent, geometric_stiffness, statics)).compliance);
          },
          py::kw_only(), py::arg("tangent") = "exact", py::arg("geometric_stiffness") = true,
          py::arg("statics") = true,
          R"(compliance($self, *, tangent='exact', geometric_stiffness=True, statics=True)
--

W of linearise(): (rows, rows) ndarray, m/N, rows and columns as `rows`.
)");
}

void bind_control(Type& type) {
  type.def_property_readonly(
          "controller",
          [](const std::shared_ptr<Session>& self) -> py::object {
            if (!self->controller()) return py::none();
            return py::cast(Controller{self, self->controller()});
          },
          "InverseController or None: what is attached. A scene's first controller is, from the "
          "start.")
      .def(
          "detach",
          [](const std::shared_ptr<Session>& self) {
            if (self->controller()) self->detach(*self->controller());
          },
          R"(detach($self)
--

Detaches the controller, if there is one. Its actuators hold where they stand until told otherwise.
)");
}

}  // namespace

void bind_simulation(py::module_& module) {
  Type type(module, "Simulation",
            R"(A running robot, from sinew.load().

Positions are in the mesh file's node order, units are SI. One thread at a time may use a
simulation (others get an Error of kind 'simulation-busy'); several simulations run side by side.)");
  bind_parts(type);
  bind_stepping(type);
  bind_state(type);
  bind_linearisation(type);
  bind_control(type);
  bind_contact_problem(module, type);
  type.def("__repr__", [](const Session& self) {
    return fmt::format("<sinew.Simulation '{}' at {:g} s: {} actuators, {} effectors>",
                       self.robot().robot.description.name, self.time(),
                       self.model().actuators().size(), self.model().effectors().size());
  });
  module.def("load_file", &load_file, py::arg("path"), py::arg("overrides"), py::arg("threads"),
             "load_file(path, overrides, threads)\n--\n\nSee sinew.load().");
  module.def("load_text", &load_text, py::arg("text"), py::arg("overrides"), py::arg("folder"),
             py::arg("name"), py::arg("threads"),
             "load_text(text, overrides, folder, name, threads)\n--\n\nSee sinew.loads().");
  module.def("load_tree", &load_tree, py::arg("tree"), py::arg("overrides"), py::arg("folder"),
             py::arg("name"), py::arg("threads"),
             "load_tree(tree, overrides, folder, name, threads)\n--\n\nSee sinew.load().");
}

}  // namespace sinew::python
