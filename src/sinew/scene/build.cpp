#include "sinew/scene/build.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "sinew/fem/fem_body_model.hpp"
#include "sinew/mesh/selection.hpp"
#include "sinew/mesh/surface.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/model_builder.hpp"

namespace sinew::scene {

namespace {

sim::Limits limits(const LimitDescription& description) {
  return {description.min, description.max, description.rate};
}

sim::Command command(const ActuatorDescription& actuator) {
  if (!actuator.command) return {};
  switch (actuator.command->kind) {
    case CommandDescription::Kind::motion:
      return {sim::CommandKind::motion, actuator.command->signal};
    case CommandDescription::Kind::effort:
      return {sim::CommandKind::effort, actuator.command->signal};
    case CommandDescription::Kind::input:
      return {sim::CommandKind::input, actuator.command->signal};
  }
  return {};
}

fem::FemBodySettings fem_settings(const SceneDescription& scene, const BodyDescription& body) {
  fem::FemBodySettings settings;
  settings.name = body.name;
  settings.mesh = std::make_shared<const mesh::Mesh>(make_body_mesh(body));
  check_element(body, *settings.mesh);
  settings.gravity = scene.gravity;
  settings.damping = {body.mass_damping, body.stiffness_damping};
  for (const MassDescription& mass : scene.masses) {
    if (mass.body != body.name) continue;
    settings.masses.push_back({mass.name, mass.place, mass.point, mass.mass, mass.outside});
  }
  if (const auto& start = body.initial_velocity) {
    settings.initial_velocity = {start->linear, start->angular};
  }
  fem::Region region;
  if (body.material.model == MaterialModel::hyperelastic) {
    region.hyperelastic = body.material.energy;
  } else {
    region.constants = {body.material.young_modulus, body.material.poisson_ratio};
    region.law = body.material.model == MaterialModel::linear ? material::Law::linear
                                                              : material::Law::corotational;
  }
  region.patches = body.element == Element::tet4_patch;
  region.density = body.density.value_or(body.mass ? 0.0 : body.material.density);
  settings.elements.regions.push_back(std::move(region));
  settings.elements.total_mass = body.mass;
  settings.elements.even_mass = body.mass_distribution == MassDistribution::even;
  settings.elements.mass = body.mass_matrix == MassMatrix::consistent ? fem::MassMatrix::consistent
                                                                      : fem::MassMatrix::lumped;
  for (const FixedRegion& fixed : body.fixed) {
    try {
      const auto nodes = mesh::select_nodes(*settings.mesh, region_of(fixed), fixed.place.item);
      if (std::ranges::all_of(fixed.axes, std::identity{})) {
        auto& all = settings.elements.fixed_nodes;
        all.insert(all.end(), nodes.begin(), nodes.end());
        continue;
      }
      for (const NodeId node : nodes) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (fixed.axes[axis]) {
            settings.elements.held_axes.push_back({node, static_cast<int>(axis)});
          }
        }
      }
    } catch (const Error& error) {
      throw error.at(fixed.place);
    }
  }
  return settings;
}

void add_cable(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body,
               std::vector<int> point_bodies) {
  sim::CableSettings cable;
  cable.name = actuator.name;
  cable.place = actuator.place;
  cable.body = body;
  cable.points = actuator.points.points;
  cable.point_places = actuator.points.places;
  cable.point_bodies = std::move(point_bodies);
  cable.pull_from_world = actuator.pull == PullPoint::world;
  cable.outside = actuator.outside;
  cable.tension = limits(actuator.effort);
  cable.tension.min = std::max(cable.tension.min, 0.0);
  cable.displacement = limits(actuator.motion);
  cable.command = command(actuator);
  cable.geometric_stiffness = actuator.geometric_stiffness;
  cable.friction = actuator.friction;
  cable.guide_radius = actuator.guide_radius;
  cable.guide_spacing = actuator.guide_spacing;
  builder.add_cable(cable);
}

void add_force(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body) {
  sim::ForceSettings force;
  force.name = actuator.name;
  force.place = actuator.place;
  force.body = body;
  force.point = actuator.point;
  force.direction = actuator.direction;
  force.outside = actuator.outside;
  force.force = limits(actuator.effort);
  force.displacement = limits(actuator.motion);
  force.command = command(actuator);
  builder.add_force(force);
}

void add_spring(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body) {
  sim::SpringLineSettings line;
  line.name = actuator.name;
  line.place = actuator.place;
  line.body = body;
  line.points = actuator.points.points;
  line.point_places = actuator.points.places;
  line.pull_from_world = actuator.pull == PullPoint::world;
  line.outside = actuator.outside;
  line.spring = actuator.spring;
  line.free_at_rest = actuator.free_at_rest;
  line.command = command(actuator);
  builder.add_spring(line);
}

void add_chamber(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body,
                 const mesh::Mesh& mesh) {
  sim::CavitySettings cavity;
  cavity.name = actuator.name;
  cavity.place = actuator.place;
  cavity.body = body;
  const SurfaceDescription& surface = actuator.surface;
  if (surface.kind == SurfaceDescription::Kind::file) {
    try {
      mesh::SurfaceOptions options;
      options.unit = surface.unit;
      const mesh::Surface read = mesh::read_surface(surface.file, options);
      mesh::require_closed(read);
      cavity.surface = read;
    } catch (const Error& error) {
      throw error.at(surface.place);
    }
  } else {
    cavity.surface = faces_of(surface, mesh);
  }
  cavity.outside = actuator.outside;
  cavity.cap = actuator.cap;
  cavity.load_stiffness = actuator.load_stiffness;
  cavity.pressure = limits(actuator.effort);
  cavity.volume_growth = limits(actuator.motion);
  cavity.command = command(actuator);
  cavity.gas = actuator.gas;
  cavity.liquid = actuator.liquid;
  builder.add_cavity(cavity);
}

void add_torque(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body) {
  sim::TorqueSettings torque;
  torque.name = actuator.name;
  torque.place = actuator.place;
  torque.body = body;
  torque.segment = actuator.segment;
  torque.towards = actuator.towards;
  torque.torque = limits(actuator.effort);
  torque.angle = limits(actuator.motion);
  torque.command = command(actuator);
  builder.add_torque(torque);
}

// @param point_bodies of the points of a cable; empty: all in its body.
void add_actuator(sim::ModelBuilder& builder, const ActuatorDescription& actuator, int body,
                  const mesh::Mesh& mesh, std::vector<int> point_bodies) {
  switch (actuator.type) {
    case ActuatorDescription::Type::cable:
      return add_cable(builder, actuator, body, std::move(point_bodies));
    case ActuatorDescription::Type::force:
      return add_force(builder, actuator, body);
    case ActuatorDescription::Type::pressure:
      return add_chamber(builder, actuator, body, mesh);
    case ActuatorDescription::Type::spring:
      return add_spring(builder, actuator, body);
    case ActuatorDescription::Type::torque:
      return add_torque(builder, actuator, body);
  }
}

void add_effector(sim::ModelBuilder& builder, const EffectorDescription& effector, int body,
                  const mesh::Mesh& mesh) {
  sim::EffectorSettings settings;
  settings.name = effector.name;
  settings.place = effector.place;
  settings.body = body;
  settings.points = effector.points.points;
  settings.outside = effector.outside;
  if (effector.kind == EffectorDescription::Kind::set) {
    settings.kind = sim::EffectorSettings::Kind::nodes;
    try {
      settings.nodes = mesh::select_nodes(mesh, mesh::NamedRegion{effector.set}, effector.name);
    } catch (const Error& error) {
      throw error.at(effector.set_place);
    }
  } else if (effector.kind == EffectorDescription::Kind::orientation) {
    settings.kind = sim::EffectorSettings::Kind::orientation;
  }
  for (Eigen::Index i = 0; i < effector.directions.rows(); ++i) {
    settings.directions.emplace_back(effector.directions.row(i).transpose());
  }
  builder.add_effector(settings);
}

SceneController controller_of(const ControllerDescription& description, const sim::Model& model) {
  SceneController controller{description.name, {}};
  auto& settings = controller.settings;
  for (const TaskDescription& task : description.tasks) {
    settings.tasks.push_back({model.effector_index(task.effector), task.target, task.weights});
  }
  for (const std::string& name : description.actuators) {
    settings.actuators.push_back(model.actuator_index(name));
  }
  settings.regularisation = description.regularisation == Regularisation::effort
                                ? inverse::Regularisation::effort
                                : inverse::Regularisation::change;
  if (description.epsilon) settings.epsilon = *description.epsilon;
  return controller;
}

sim::StepSettings step_settings(const SceneDescription& scene) {
  sim::StepSettings step;
  step.time_step = scene.time_step;
  step.integrator = scene.integrator;
  step.spectral_radius = scene.spectral_radius;
  step.adaptive = scene.solver.adaptive;
  step.method =
      scene.solver.method == Method::newton ? sim::Method::newton : sim::Method::one_linearisation;
  switch (scene.solver.tangent) {
    case Tangent::rotated:
      step.tangent = mechanics::Tangent::real_time;
      break;
    case Tangent::projected:
      step.tangent = mechanics::Tangent::projected;
      break;
    case Tangent::exact:
      step.tangent = mechanics::Tangent::exact;
      break;
  }
  step.tolerance = scene.solver.tolerance;
  step.max_iterations = scene.solver.max_iterations;
  step.contact_tolerance = scene.solver.contact_tolerance;
  return step;
}

}  // namespace

Robot build(SceneDescription description) {
  Robot robot;
  sim::ModelBuilder builder(step_settings(description));
  std::vector<std::shared_ptr<const mesh::Mesh>> meshes;
  const auto body_index = [&](const std::string& name) {
    const auto found = std::ranges::find(description.bodies, name, &BodyDescription::name);
    return static_cast<int>(found - description.bodies.begin());
  };
  for (const BodyDescription& body : description.bodies) {
    try {
      if (body.arm) {
        pcc::ArmSettings settings = *body.arm;
        settings.gravity = description.gravity;
        const int number = builder.add_arm(std::move(settings));
        meshes.push_back(std::make_shared<const mesh::Mesh>(builder.added_body(number).mesh()));
        continue;
      }
      auto settings = fem_settings(description, body);
      meshes.push_back(settings.mesh);
      if (auto notice = locking_notice(body, *settings.mesh)) {
        robot.notices.push_back(std::move(*notice));
      }
      const int number = builder.add_fem_body(std::move(settings), body.place);
      if (body.base) {
        builder.add_base_motion(
            {number, body.base->translation, body.base->angle, body.base->axis, body.base->center},
            body.base->place);
      }
    } catch (const Error& error) {
      throw error.at(body.place);
    }
  }
  for (const ActuatorDescription& actuator : description.actuators) {
    const int body = body_index(actuator.body);
    std::vector<int> point_bodies;
    for (const std::string& name : actuator.points.bodies) {
      point_bodies.push_back(name.empty() ? body : body_index(name));
    }
    add_actuator(builder, actuator, body, *meshes[static_cast<std::size_t>(body)],
                 std::move(point_bodies));
  }
  for (const EffectorDescription& effector : description.effectors) {
    const int body = body_index(effector.body);
    add_effector(builder, effector, body, *meshes[static_cast<std::size_t>(body)]);
  }
  const auto built = [&](const std::string& name) -> BuiltBody {
    const int body = body_index(name);
    return {body, meshes[static_cast<std::size_t>(body)].get()};
  };
  for (const LoadDescription& load : description.loads) add_load(builder, load, built);
  for (const ProbeDescription& probe : description.probes) add_probe(builder, probe, built);
  for (const ContactDescription& contact : description.contacts) {
    add_contact(builder, contact, built);
  }
  for (const JointDescription& joint : description.joints) add_joint(builder, joint, built);
  linalg::FactorisationSettings factorisation;
  factorisation.backend = description.solver.backend;
  factorisation.ordering = description.solver.ordering;
  factorisation.threads = description.solver.threads;
  robot.model = builder.build(factorisation);
  for (const ControllerDescription& controller : description.controllers) {
    robot.controllers.push_back(controller_of(controller, *robot.model));
  }
  robot.description = std::move(description);
  return robot;
}

Robot load(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  if (overrides.empty()) return build(parse_scene(path));
  Node tree = read_yaml(path);
  for (const std::string& assignment : overrides) apply_override(tree, assignment);
  SceneDescription description = parse_scene_tree(std::move(tree), path.parent_path());
  description.name = path.stem().string();
  return build(std::move(description));
}

}  // namespace sinew::scene
