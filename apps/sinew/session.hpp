/// @file
/// Scenes and simulations for commands such as `run` and `bench`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/control/target_controller.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/watched.hpp"

namespace sinew::cli {

class Command;
class ProgressBar;

/// Command-line options for a scene.
struct SceneOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;  ///< "path=value"
  std::optional<int> threads;
  std::string controller;  ///< a name, "none", or empty for the first of the scene
};

/// A scene loaded with the options of the command line.
struct LoadedScene {
  scene::Robot robot;
  std::string controller;  ///< name of the controller to attach; empty for none
};

/// Reads and builds a scene, and prints its warnings. Throws what scene::load() throws, and
/// Error(unknown-name) for an unknown controller. @param options of the command line.
LoadedScene load_scene(const SceneOptions& options);

/// A robot with one simulation and its controller.
class Session {
 public:
  /// Reads and builds a scene, prints its warnings and attaches the controller. Throws what
  /// load_scene() throws. @param options of the command line.
  explicit Session(const SceneOptions& options);

  const scene::Robot& robot() const { return robot_; }
  sim::Simulation& simulation() { return *simulation_; }
  /// The controller; null if there is none.
  const control::TargetController* controller() const { return controller_.get(); }
  const std::string& controller_name() const { return controller_name_; }
  /// @param keeps_going whether a step that fails is kept, see sim::Simulation::step().
  void step(bool keeps_going = false) {
    simulation_->step(keeps_going ? sim::OnFailure::keep_going : sim::OnFailure::stop);
  }

  /// Time at which all targets have completed their first turn, s; 0 if none moves.
  double first_turn() const;
  /// The largest distance of an effector from its target, m or rad; 0 without a controller.
  double error() const { return controller_ ? controller_->error() : 0.0; }
  /// The resolved scene as YAML, with overrides applied and absolute paths.
  std::string resolved_scene() const;

 private:
  scene::Robot robot_;
  std::filesystem::path folder_;
  std::unique_ptr<sim::Simulation> simulation_;
  std::string controller_name_;
  std::unique_ptr<control::TargetController> controller_;
};

/// While the result exists, Ctrl-C ends the current step (by throwing Interrupted, see
/// terminal.hpp), and steps of more than two seconds are reported. All arguments must outlive the
/// result.
/// @param simulation to be watched. @param bar shows the report. @param done steps so far.
sim::Watched watch_steps(sim::Simulation& simulation, ProgressBar& bar, const std::int64_t& done);

/// Adds SCENE, --set, --threads and --controller to a command.
/// @param command to add to. @param options to fill. @param optional whether SCENE may be omitted.
void add_scene_options(Command& command, SceneOptions& options, bool optional = false);

}  // namespace sinew::cli
