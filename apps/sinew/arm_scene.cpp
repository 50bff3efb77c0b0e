#include "arm_scene.hpp"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/scene/actuator_kind.hpp"
#include "sinew/scene/build.hpp"

#include "command_line.hpp"

namespace sinew::cli {

namespace {

using scene::ActuatorDescription;
using scene::BodyDescription;
using scene::SceneDescription;

const BodyDescription& choose(const SceneDescription& scene, const std::string& name) {
  std::vector<std::string> names, arms;
  for (const BodyDescription& body : scene.bodies) {
    names.push_back(body.name);
    if (body.as<pcc::ArmSettings>() != nullptr) arms.push_back(body.name);
  }
  if (arms.empty()) {
    throw Error(ErrorKind::wrong_type, {.item = "bodies"},
                fmt::format("the scene has no arm; its bodies are {}", fmt::join(names, ", ")),
                "use a scene with a body of type pcc, such as examples/fluidic_arm/arm.yaml");
  }
  if (name.empty() && arms.size() > 1) {
    throw Error(ErrorKind::bad_argument, {.item = "--body"},
                fmt::format("the scene has {} arms", arms.size()),
                fmt::format("name one of {}", fmt::join(arms, ", ")));
  }
  const std::string& wanted = name.empty() ? arms.front() : name;
  const auto found = std::ranges::find(scene.bodies, wanted, &BodyDescription::name);
  if (found == scene.bodies.end()) {
    const std::string near = nearest_word(wanted, names);
    throw Error(ErrorKind::unknown_name, {.item = "--body"},
                fmt::format("the scene has no body '{}'", wanted),
                near.empty() ? fmt::format("its arms are {}", fmt::join(arms, ", "))
                             : fmt::format("did you mean '{}'?", near));
  }
  if (found->as<pcc::ArmSettings>() == nullptr) {
    throw Error(ErrorKind::wrong_type, {.item = "--body"},
                fmt::format("body '{}' is not an arm of type pcc", wanted),
                fmt::format("name one of {}", fmt::join(arms, ", ")));
  }
  return *found;
}

std::vector<const ActuatorDescription*> torques_on(const SceneDescription& scene,
                                                   const std::string& body) {
  std::vector<const ActuatorDescription*> torques;
  for (const ActuatorDescription& actuator : scene.actuators) {
    if (actuator.body == body && actuator.as<builder::TorqueSettings>() != nullptr) {
      torques.push_back(&actuator);
    }
  }
  return torques;
}

std::vector<std::string> left_out(const SceneDescription& scene, const std::string& body,
                                  bool takes_contacts) {
  std::vector<std::string> names;
  for (const ActuatorDescription& actuator : scene.actuators) {
    if (actuator.body != body || actuator.as<builder::TorqueSettings>() != nullptr) continue;
    names.push_back(fmt::format("{} '{}'", actuator.kind->word(), actuator.name));
  }
  for (const auto& joint : scene.joints) {
    if (joint.first != body && joint.second != body) continue;
    names.push_back(fmt::format("joint '{}'", joint.name));
  }
  for (const auto& load : scene.loads) {
    if (load.body == body) names.push_back(fmt::format("load '{}'", load.name));
  }
  for (const auto& contact : scene.contacts) {
    const bool taken = takes_contacts && contact.other.empty();
    if (taken || (contact.body != body && contact.other != body)) continue;
    names.push_back(fmt::format("contact '{}'", contact.name));
  }
  return names;
}

// Makes actuators the inputs of the arm. The limits of several actuators on one bend all apply.
void take_inputs(ArmScene& scene, pcc::ArmSettings settings,
                 const std::vector<const ActuatorDescription*>& torques) {
  const pcc::Arm plain(settings);
  const Eigen::Index n = plain.coordinates(), inputs = std::ssize(torques);
  settings.actuation = MatrixX::Zero(n, inputs);
  scene.torque_lower = VectorX::Constant(inputs, -kInfinity);
  scene.torque_upper = scene.torque_rate = VectorX::Constant(inputs, kInfinity);
  scene.angle_lower = VectorX::Constant(n, -kInfinity);
  scene.angle_upper = scene.rate = VectorX::Constant(n, kInfinity);
  for (Eigen::Index u = 0; u < inputs; ++u) {
    const ActuatorDescription& actuator = *torques[static_cast<std::size_t>(u)];
    const auto& torque = *actuator.as<builder::TorqueSettings>();
    const Eigen::Index bend = plain.first(torque.segment) + static_cast<int>(torque.towards);
    settings.actuation(bend, u) = 1.0;
    scene.inputs.push_back(actuator.name);
    scene.torque_lower[u] = torque.torque.min;
    scene.torque_upper[u] = torque.torque.max;
    scene.torque_rate[u] = torque.torque.rate;
    scene.angle_lower[bend] = std::max(scene.angle_lower[bend], torque.angle.min);
    scene.angle_upper[bend] = std::min(scene.angle_upper[bend], torque.angle.max);
    scene.rate[bend] = std::min(scene.rate[bend], torque.angle.rate);
  }
  scene.arm = std::make_shared<const pcc::Arm>(std::move(settings));
}

}  // namespace

ArmScene load_arm_scene(const ArmSceneOptions& options) {
  ArmScene result;
  // Builds the whole scene, so that it gives the same errors as when it is run.
  result.description = scene::load(options.file, options.overrides).description;
  try {
    const BodyDescription& body = choose(result.description, options.body);
    pcc::ArmSettings settings = *body.as<pcc::ArmSettings>();
    settings.gravity = result.description.gravity;
    take_inputs(result, std::move(settings), torques_on(result.description, body.name));
    result.left_out = left_out(result.description, body.name, options.takes_contacts);
  } catch (const Error& error) {
    throw error.at({.file = options.file.string()});
  }
  return result;
}

void print_left_out(const ArmScene& scene) {
  if (scene.left_out.empty()) return;
  fmt::print("ignored: {}\n", fmt::join(scene.left_out, ", "));
}

void add_arm_scene_options(Command& command, ArmSceneOptions& options) {
  command.add_option("SCENE", options.file, "Scene file (YAML) with a body of type pcc").required();
  command
      .add_option("--set", options.overrides,
                  "Override a scene value, e.g. bodies.arm.segments.0.mass=200g (repeatable)")
      .type_name("PATH=VALUE")
      .allow_extra_args(false);
  command.add_option("--body", options.body, "Arm to use, if the scene has several")
      .type_name("NAME");
}

}  // namespace sinew::cli
