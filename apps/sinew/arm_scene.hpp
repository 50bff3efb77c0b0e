/// @file
/// A constant-curvature arm of a scene, as planning and identification take it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/scene/description.hpp"

namespace sinew::cli {

class Command;

/// What the command line says about a scene with an arm.
struct ArmSceneOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;  ///< "path=value"
  std::string body;                    ///< empty: the only arm
  bool takes_contacts = false;         ///< the command makes use of contacts with the arm
};

/// The arm alone: its inputs are the scene's actuators of type torque, in the scene's order.
struct ArmScene {
  scene::SceneDescription description;
  std::shared_ptr<const pcc::Arm> arm;
  std::vector<std::string> inputs;         ///< names of the actuators
  VectorX torque_lower, torque_upper;      ///< (inputs,) N m; without a limit +-infinity
  VectorX torque_rate;                     ///< (inputs,) N m/s; likewise
  VectorX angle_lower, angle_upper, rate;  ///< (coordinates,) rad, rad/s; likewise
  std::vector<std::string> left_out;       ///< what else acts on the arm, "cable 'pull'"
};

/// Reads a scene and takes its arm. Throws what scene::load() does, and Error(unknown-name) where
/// the body is none of the scene's, Error(wrong-type) where it is no arm or the scene has none,
/// Error(bad-argument) where it has several and none was named.
/// @param options see there.
ArmScene load_arm_scene(const ArmSceneOptions& options);

/// Says what of the scene a command does not take into account, if anything.
/// @param scene which.
void print_left_out(const ArmScene& scene);

/// Adds SCENE, --set and --body to a command.
/// @param command to add to. @param options to fill.
void add_arm_scene_options(Command& command, ArmSceneOptions& options);

}  // namespace sinew::cli
