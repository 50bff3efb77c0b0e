/// @file
/// Reads a constant-curvature arm from a scene, for planning and identification.
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

/// Command-line options for a scene with an arm.
struct ArmSceneOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;  ///< "path=value"
  std::string body;                    ///< name of the arm; empty: the only arm
  bool takes_contacts = false;         ///< whether the command uses contacts of the arm
};

/// An arm without the rest of its scene. Its inputs are the scene's actuators of type torque, in
/// their order.
struct ArmScene {
  scene::SceneDescription description;
  std::shared_ptr<const pcc::Arm> arm;
  std::vector<std::string> inputs;         ///< names of the actuators
  VectorX torque_lower, torque_upper;      ///< (inputs,) N m; +-infinity without limit
  VectorX torque_rate;                     ///< (inputs,) N m/s; infinity without limit
  VectorX angle_lower, angle_upper, rate;  ///< (coordinates,) rad, rad/s; likewise
  std::vector<std::string> left_out;       ///< whatever else acts on the arm: "cable 'pull'"
};

/// Reads a scene and extracts its arm. Throws what scene::load() throws, and Error: unknown-name
/// (no such body), wrong-type (the body is not an arm, or the scene has none), bad-argument (the
/// scene has several arms, and none was named). @param options of the command line.
ArmScene load_arm_scene(const ArmSceneOptions& options);

/// Prints the parts of the scene that the command ignores, if any. @param scene of the arm.
void print_left_out(const ArmScene& scene);

/// Adds SCENE, --set and --body to a command.
/// @param command to add to. @param options to fill.
void add_arm_scene_options(Command& command, ArmSceneOptions& options);

}  // namespace sinew::cli
