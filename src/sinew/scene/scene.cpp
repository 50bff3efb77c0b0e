#include "sinew/scene/scene.hpp"

#include <algorithm>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/check.hpp"
#include "sinew/scene/readers.hpp"
#include "sinew/scene/renamed_words.hpp"
#include "sinew/scene/suspicious_units.hpp"

namespace sinew::scene {

namespace {

void read_integrator(const Fields& fields, SceneDescription& scene) {
  std::string word = "quasi-static";
  scene.integrator_place = fields.place("integrator");
  if (fields.find("integrator") == nullptr) return;
  if (fields.form("integrator").shape == Shape::choice) {
    fields.read_word("integrator", word);
  } else {
    fields.below("integrator").read_word("type", word);
    fields.below("integrator").read("spectral_radius", scene.spectral_radius);
    fields.below("integrator").read("restitution", scene.restitution);
  }
  for (const Integrator integrator :
       {Integrator::quasi_static, Integrator::backward_euler, Integrator::bdf2,
        Integrator::generalized_alpha, Integrator::event_driven}) {
    if (word == mechanics::integrator_name(integrator)) scene.integrator = integrator;
  }
  if (scene.restitution == 0.0 || scene.integrator == Integrator::event_driven) return;
  throw Error(ErrorKind::conflicting_keys, fields.below("integrator").place("restitution"),
              fmt::format("{} knows no restitution", word),
              "write type: event-driven, or leave `restitution` out");
}

void read_solver(const Fields& fields, SolverDescription& solver) {
  const std::initializer_list<std::pair<const char*, Method>> methods = {
      {"one-linearisation", Method::one_linearisation}, {"newton", Method::newton}};
  solver.place = fields.place("solver");
  if (fields.find("solver") != nullptr && fields.form("solver").shape == Shape::choice) {
    fields.read_choice("solver", solver.method, methods);
    return;
  }
  const Fields values = fields.below("solver");
  values.read_choice("method", solver.method, methods);
  std::string tangent;
  if (values.read_word("tangent", tangent)) {
    solver.tangent = mechanics::tangent_of(tangent).value();
  }
  if (values.find("adaptive") != nullptr) {
    auto& adaptive = solver.adaptive.emplace();
    values.below("adaptive").read("tolerance", adaptive.tolerance);
    values.below("adaptive").read("smallest", adaptive.smallest);
  }
  if (values.find("equilibrium") != nullptr) {
    values.read_choice(
        "equilibrium", solver.equilibrium.emplace(),
        {{"converged", Equilibrium::converged}, {"following", Equilibrium::following}});
  }
  if (values.find("tolerance") != nullptr) values.read("tolerance", solver.tolerance.emplace());
  values.read("max_iterations", solver.max_iterations);
  values.read("contact_tolerance", solver.contact_tolerance);
  values.read("threads", solver.threads);
  values.read_word("factorisation", solver.backend);
  values.read_choice("ordering", solver.ordering,
                     {{"amd", linalg::Ordering::amd},
                      {"metis", linalg::Ordering::metis},
                      {"fastest", linalg::Ordering::fastest}});
}

void read_world(const Fields& fields, SceneDescription& scene) {
  fields.read("sinew", scene.version);
  fields.read("gravity", scene.gravity);
  scene.gravity_place = fields.place("gravity");
  fields.read("time_step", scene.time_step);
  double duration = 0.0;
  if (fields.read("duration", duration)) scene.duration = duration;
  read_integrator(fields, scene);
  read_solver(fields, scene.solver);
  scene.record.place = fields.place("record");
  const Fields record = fields.below("record");
  record.read("every", scene.record.every);
  record.read("states", scene.record.states);
}

template <typename Read>
void for_entries(const Fields& fields, const char* key, Read&& read) {
  const Node* map = fields.find(key);
  if (map == nullptr) return;
  for (const Node::Entry& entry : map->entries()) read(entry);
}

// Checks that bodies have a mass if there is gravity or inertia.
void check_mass(const SceneDescription& scene) {
  const bool needed =
      scene.gravity != Vector3::Zero() || scene.integrator != Integrator::quasi_static;
  if (!needed) return;
  for (const BodyDescription& body : scene.bodies) {
    if (!body.kind->has_elements || body.mass || body.density || body.material.density > 0.0)
      continue;
    throw Error(ErrorKind::missing_mass, body.place,
                fmt::format("'{}' has no mass, but there is {}", body.name,
                            scene.integrator != Integrator::quasi_static ? "inertia" : "gravity"),
                "add mass: 42 g, or density: 1070 kg/m^3");
  }
}

// Checks that point masses and membranes are on finite-element bodies.
void check_carriers(const SceneDescription& scene) {
  const auto check = [&](const std::string& name, const Location& place, const char* what,
                         const char* remedy) {
    const auto body = std::ranges::find(scene.bodies, name, &BodyDescription::name);
    if (body == scene.bodies.end() || body->kind->has_elements) return;
    throw Error(ErrorKind::wrong_type, place,
                fmt::format("'{}' is {}, which carries no {}", name, body->kind->noun, what),
                remedy != nullptr ? remedy : body->kind->carry_masses);
  };
  for (const MassDescription& mass : scene.masses) {
    check(mass.body, mass.body_place, "point masses", nullptr);
  }
  for (const MembraneDescription& layer : scene.membranes) {
    check(layer.body, layer.body_place, "membranes",
          "make the body of type fem, or leave the membrane out");
  }
}

void check_initial_velocities(const SceneDescription& scene) {
  if (scene.integrator != Integrator::quasi_static) return;
  for (const BodyDescription& body : scene.bodies) {
    const auto& start = body.velocity;
    if (!start || (start->linear.isZero(0.0) && start->angular.isZero(0.0))) continue;
    throw Error(ErrorKind::conflicting_keys, start->place,
                fmt::format("'{}' has an initial velocity, but the integrator is quasi-static, "
                            "which knows no inertia",
                            body.name),
                "choose a dynamic integrator such as bdf2, or leave the velocity out");
  }
}

// Checks that no actuator is driven by two controllers.
void check_owners(const SceneDescription& scene) {
  std::map<std::string, std::string> owners;
  for (const ControllerDescription& controller : scene.controllers) {
    if (scene.actuators.empty()) {
      throw Error(ErrorKind::no_actuators, controller.place,
                  fmt::format("'{}' has nothing to drive", controller.name),
                  "add actuators to the scene");
    }
    std::vector<std::string> driven = controller.actuators;
    if (driven.empty()) {
      for (const ActuatorDescription& actuator : scene.actuators) driven.push_back(actuator.name);
    }
    for (std::size_t i = 0; i < driven.size(); ++i) {
      const auto [owner, is_new] = owners.emplace(driven[i], controller.name);
      if (is_new) continue;
      const bool named = !controller.actuators.empty();
      throw Error(ErrorKind::actuator_owned,
                  named ? controller.actuator_places[i] : controller.place,
                  fmt::format("'{}' is driven by '{}' already", driven[i], owner->second),
                  "give each controller its own list of actuators");
    }
  }
}

SceneDescription read_scene(const Node& tree, const ReadContext& context) {
  SceneDescription scene;
  scene.place = tree.place();
  const Fields fields(tree, grammar());
  read_world(fields, scene);
  for_entries(fields, "bodies", [&](const auto& entry) {
    if (is_plane(entry)) {
      scene.planes.push_back(read_plane(entry, context));
    } else {
      scene.bodies.push_back(read_body(entry, context));
    }
  });
  for_entries(fields, "actuators",
              [&](const auto& entry) { scene.actuators.push_back(read_actuator(entry, context)); });
  for_entries(fields, "loads",
              [&](const auto& entry) { scene.loads.push_back(read_load(entry, context)); });
  for_entries(fields, "masses",
              [&](const auto& entry) { scene.masses.push_back(read_hung_mass(entry)); });
  for_entries(fields, "membranes",
              [&](const auto& entry) { scene.membranes.push_back(read_membrane(entry, context)); });
  for_entries(fields, "effectors",
              [&](const auto& entry) { scene.effectors.push_back(read_effector(entry, context)); });
  for_entries(fields, "probes",
              [&](const auto& entry) { scene.probes.push_back(read_probe(entry, context)); });
  for_entries(fields, "sensors",
              [&](const auto& entry) { scene.sensors.push_back(read_sensor(entry, context)); });
  for_entries(fields, "estimators",
              [&](const auto& entry) { scene.estimators.push_back(read_estimator(entry)); });
  for_entries(fields, "contacts",
              [&](const auto& entry) { scene.contacts.push_back(read_contact(entry, context)); });
  for_entries(fields, "joints",
              [&](const auto& entry) { scene.joints.push_back(read_joint(entry, context)); });
  for_entries(fields, "controllers", [&](const auto& entry) {
    scene.controllers.push_back(read_controller(entry, context, scene));
  });
  check_mass(scene);
  check_carriers(scene);
  check_initial_velocities(scene);
  check_owners(scene);
  return scene;
}

}  // namespace

double SceneDescription::run_duration() const {
  if (duration) return *duration;
  double end = 0.0;
  for (const ActuatorDescription& actuator : actuators) {
    end = std::max(end, actuator.command.signal.end_time());
  }
  const auto include = [&](const std::optional<model::BaseMotion>& motion) {
    if (!motion) return;
    for (const model::Signal& signal : motion->translation) end = std::max(end, signal.end_time());
    end = std::max(end, motion->angle.end_time());
  };
  for (const BodyDescription& body : bodies) include(body.motion);
  for (const PlaneDescription& plane : planes) include(plane.motion);
  for (const ContactDescription& contact : contacts) include(contact.motion);
  for (const LoadDescription& load : loads) end = std::max(end, load.factor.end_time());
  for (const ControllerDescription& controller : controllers) {
    for (const TaskDescription& task : controller.tasks) {
      end = std::max(end, task.target.end_time());
    }
  }
  return end;
}

SceneDescription parse_scene(const std::filesystem::path& path) {
  return parse_scene_tree(read_yaml(path), path.parent_path());
}

SceneDescription parse_scene_text(std::string_view text, const std::string& name,
                                  const std::filesystem::path& base_dir, Files files) {
  return parse_scene_tree(parse_yaml(text, name), base_dir, files);
}

SceneDescription parse_recorded_scene(std::string_view text, const std::string& name) {
  Node tree = parse_yaml(text, name);
  replace_old_words(tree);
  return parse_scene_tree(std::move(tree));
}

SceneDescription parse_scene_tree(Node tree, const std::filesystem::path& base_dir, Files files) {
  tree.name_paths();
  std::vector<Notice> notices = replace_old_words(tree);
  if (!notices.empty()) tree.name_paths();
  check_scene(tree);
  SceneDescription scene = read_scene(tree, {base_dir, files});
  std::ranges::move(suspicious_units(tree, {base_dir, files}), std::back_inserter(notices));
  scene.notices = std::move(notices);
  const std::filesystem::path file = tree.place().file;
  scene.name = file.has_stem() ? file.stem().string() : "scene";
  scene.tree = std::move(tree);
  return scene;
}

SceneDescription parse_changed_scene(Node tree, const std::vector<std::string>& overrides,
                                     const std::filesystem::path& base_dir) {
  std::vector<Notice> notices;
  for (const std::string& assignment : overrides) {
    std::ranges::move(apply_override(tree, assignment), std::back_inserter(notices));
  }
  SceneDescription scene = parse_scene_tree(std::move(tree), base_dir);
  scene.notices.insert(scene.notices.begin(), notices.begin(), notices.end());
  return scene;
}

}  // namespace sinew::scene
