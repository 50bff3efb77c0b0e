#include "sinew/scene/build.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "sinew/builder/model_builder.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/actuator_kind.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/build_parts.hpp"
#include "sinew/scene/controller_kind.hpp"
#include "sinew/scene/joint_kind.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/scene/sensor_kind.hpp"
#include "sinew/sense/sensor_set.hpp"

namespace sinew::scene {

namespace {

SceneController controller_of(const ControllerDescription& description, const model::Model& model) {
  control::TargetSettings targets;
  for (const TaskDescription& task : description.tasks) {
    targets.tasks.push_back(
        {model.effector_index(task.effector), task.target, task.weights, task.priority});
  }
  for (const std::string& name : description.actuators) {
    targets.actuators.push_back(model.actuator_index(name));
  }
  return {description.name, description.kind->build({description, model, std::move(targets)})};
}

model::StepSettings step_settings(const SceneDescription& scene) {
  model::StepSettings step;
  step.place = scene.integrator_place;
  step.time_step = scene.time_step;
  step.integrator = scene.integrator;
  step.spectral_radius = scene.spectral_radius;
  step.restitution = scene.restitution;
  step.adaptive = scene.solver.adaptive;
  step.method = scene.solver.method;
  step.tangent = scene.solver.tangent;
  step.equilibrium = scene.solver.equilibrium;
  step.tolerance = scene.solver.tolerance;
  step.max_iterations = scene.solver.max_iterations;
  step.contact_tolerance = scene.solver.contact_tolerance;
  return step;
}

// Only corotational elements have a corotated tangent. That of rubber would be the projected one,
// which needs ten iterations for one with the exact tangent, so the robot uses the exact one.
std::optional<Notice> replace_tangent(const SceneDescription& scene, model::StepSettings& step) {
  const auto rubber = std::ranges::find_if(scene.bodies, [](const BodyDescription& body) {
    const auto is_rubber = [](const auto& of) { return of.material.is_hyperelastic(); };
    return body.kind->has_elements &&
           (is_rubber(body) || std::ranges::any_of(body.parts, is_rubber));
  });
  if (scene.solver.tangent != Tangent::corotated || rubber == scene.bodies.end())
    return std::nullopt;
  step.tangent = mechanics::Tangent::exact;
  return Notice{
      NoticeLevel::warning, NoticeKind::other_tangent, scene.solver.place,
      fmt::format("the material of body '{}' has no corotated tangent, which corotational "
                  "elements have: steps take the exact one",
                  rubber->name),
      "leave out `tangent`, or write `tangent: exact`"};
}

}  // namespace

const SceneController* Robot::first_controller() const {
  return controllers.empty() ? nullptr : &controllers.front();
}

const SceneController& Robot::controller(const std::string& name, const Location& asked) const {
  std::vector<std::string> known;
  for (const SceneController& one : controllers) {
    if (one.name == name) return one;
    known.push_back(one.name);
  }
  const std::string nearest = nearest_word(name, known);
  throw Error(ErrorKind::unknown_name, asked, fmt::format("the scene has no controller '{}'", name),
              !nearest.empty() ? fmt::format("did you mean '{}'?", nearest)
              : known.empty()  ? "the scene has none"
                               : fmt::format("choose among {}", fmt::join(known, ", ")));
}

Robot build(SceneDescription description) { return build(std::move(description), {}); }

Robot build(SceneDescription description, const SharedMeshes& shared) {
  Robot robot;
  robot.notices = description.notices;
  model::StepSettings step = step_settings(description);
  if (auto notice = replace_tangent(description, step)) {
    robot.notices.push_back(std::move(*notice));
  }
  std::ranges::move(expand_urdf(description), std::back_inserter(robot.notices));
  builder::ModelBuilder builder(step);
  for (const BodyDescription& body : description.bodies) {
    const auto made = shared.find(body.name);
    add_body(builder, description, body, made == shared.end() ? nullptr : &made->second);
    const int number = static_cast<int>(&body - description.bodies.data());
    std::ranges::move(law_notices(body), std::back_inserter(robot.notices));
    if (auto notice = loose_part_notice(body.place, builder.added_body(number))) {
      robot.notices.push_back(std::move(*notice));
    }
  }
  const auto of_bodies = static_cast<std::ptrdiff_t>(robot.notices.size());
  const BodyOf body_of = [&](const std::string& name) -> BuiltBody {
    const auto found = std::ranges::find(description.bodies, name, &BodyDescription::name);
    if (found == description.bodies.end()) return {model::kWorld};
    const int number = static_cast<int>(found - description.bodies.begin());
    return {number, &builder.added_body(number)};
  };
  for (const auto& [link, body] : description.link_bodies) {
    if (link != body) builder.name_body(link, body_of(body).number);
  }
  // Welds are added last, to match the order of rows in saved states. Motors need the other joints
  // first.
  std::map<std::string, int> joints;
  const auto add_joints = [&](bool bonds) {
    for (const JointDescription& joint : description.joints) {
      if (joint.kind->is_bond != bonds) continue;
      joints[joint.name] = joint.kind->add({builder, joint, body_of});
    }
  };
  add_joints(false);
  const JointOf joint_of = [&](const std::string& name) { return joints.at(name); };
  for (const ActuatorDescription& actuator : description.actuators) {
    actuator.kind->add({builder, description, actuator, body_of, joint_of});
    if (actuator.as<CableDescription>() == nullptr) continue;
    const mechanics::BodyModel& body = builder.added_body(body_of(actuator.body).number);
    if (auto notice = bare_points_notice(actuator, body)) {
      robot.notices.push_back(std::move(*notice));
    }
  }
  for (const EffectorDescription& effector : description.effectors) {
    add_effector(builder, effector, body_of);
  }
  for (const LoadDescription& load : description.loads) add_load(builder, load, body_of);
  for (const ProbeDescription& probe : description.probes) add_probe(builder, probe, body_of);
  const std::vector<SceneContact> contacts = contact_pairs(description);
  for (const SceneContact& one : contacts) {
    if (auto notice = add_contact(builder, one.contact, body_of)) {
      robot.notices.push_back(std::move(*notice));
    }
  }
  add_joints(true);
  for (const SensorDescription& sensor : description.sensors) {
    add_sensor(builder, {description, contacts, body_of, sensor});
  }
  for (const EstimatorDescription& estimator : description.estimators) {
    add_estimator(builder, description, estimator);
  }
  robot.model = builder.build();
  std::ranges::move(locking_notices(description, *robot.model, shared),
                    std::inserter(robot.notices, robot.notices.begin() + of_bodies));
  for (const ControllerDescription& controller : description.controllers) {
    robot.controllers.push_back(controller_of(controller, *robot.model));
  }
  robot.description = std::move(description);
  return robot;
}

Robot load(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  if (overrides.empty()) return build(parse_scene(path));
  SceneDescription description =
      parse_changed_scene(read_yaml(path), overrides, path.parent_path());
  description.name = path.stem().string();
  return build(std::move(description));
}

}  // namespace sinew::scene
