// Binds sinew.Simulation, and loading of scenes.
#include <fmt/format.h>

#include "sinew/model/model.hpp"
#include "sinew/scene/renamed_words.hpp"
#include "sinew/scene/scene.hpp"

#include "simulation_type.hpp"
#include "tree.hpp"

namespace sinew::python {

namespace {

namespace fs = std::filesystem;

std::shared_ptr<Session> build(scene::Node tree, const std::vector<std::string>& overrides,
                               const fs::path& folder, const std::string& name,
                               const std::optional<int>& threads) {
  const py::gil_scoped_release release;
  auto description = scene::parse_changed_scene(std::move(tree), overrides, folder);
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

std::shared_ptr<Session> load_recorded(const std::string& text) {
  scene::Node tree = scene::parse_yaml(text, "scene");
  scene::replace_old_words(tree);
  return build(std::move(tree), {}, {}, "scene", std::nullopt);
}

std::shared_ptr<Session> load_tree(const py::object& tree,
                                   const std::vector<std::string>& overrides,
                                   const std::string& folder, const std::string& name,
                                   const std::optional<int>& threads) {
  return build(to_tree(tree), overrides, folder, name, threads);
}

void bind_control(SimulationType& type) {
  type.def_property_readonly(
          "controller",
          [](const std::shared_ptr<Session>& self) -> py::object {
            if (!self->controller()) return py::none();
            return py::cast(Controller{self, self->controller()});
          },
          "InverseController or None: the attached controller. Initially the first one of the "
          "scene.")
      .def(
          "detach",
          [](const std::shared_ptr<Session>& self) {
            if (self->controller()) self->detach(*self->controller());
          },
          R"(detach($self)
--

Detaches the controller, if any. Its actuators hold their present displacements until they get
another command.
)");
}

void bind_load_functions(py::module_& module) {
  module.def("load_file", &load_file, py::arg("path"), py::arg("overrides"), py::arg("threads"),
             "load_file(path, overrides, threads)\n--\n\nSee sinew.load().");
  module.def("load_text", &load_text, py::arg("text"), py::arg("overrides"), py::arg("folder"),
             py::arg("name"), py::arg("threads"),
             "load_text(text, overrides, folder, name, threads)\n--\n\nSee sinew.loads().");
  module.def("load_recorded", &load_recorded, py::arg("text"), R"(load_recorded(text)
--

The robot of a recorded run. Renamed words in its scene are replaced.

Parameters
----------
text : str
    The scene in run.h5, YAML.

Returns
-------
Simulation
)");
  module.def("load_tree", &load_tree, py::arg("tree"), py::arg("overrides"), py::arg("folder"),
             py::arg("name"), py::arg("threads"),
             "load_tree(tree, overrides, folder, name, threads)\n--\n\nSee sinew.load().");
}

}  // namespace

void bind_simulation(py::module_& module) {
  SimulationType type(module, "Simulation",
                      R"(A simulated robot, from sinew.load().

Positions are in the node order of the mesh file, in SI units. Only one thread at a time may use a
simulation (others get an Error of kind 'simulation-busy'); several simulations may run in
parallel.)");
  bind_simulation_parts(type);
  bind_simulation_stepping(type);
  bind_simulation_state(type);
  bind_simulation_reports(type);
  bind_simulation_linearisation(type);
  bind_simulation_linear_model(type);
  bind_simulation_parameters(type);
  bind_simulation_response(type);
  bind_control(type);
  bind_contact_problem(module, type);
  type.def("__repr__", [](const Session& self) {
    return fmt::format("<sinew.Simulation '{}' at {:g} s: {} actuators, {} effectors>",
                       self.robot().robot.description.name, self.time(),
                       self.model().actuators().size(), self.model().effectors().size());
  });
  bind_load_functions(module);
}

}  // namespace sinew::python
