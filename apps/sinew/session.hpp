/// @file
/// A scene made ready to run, as `run` and `bench` need it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/inverse/target_controller.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/watched.hpp"

namespace sinew::cli {

class Command;
class ProgressBar;

/// What the command line says about a scene.
struct SceneOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;  ///< "path=value"
  std::optional<int> threads;
  std::string controller;  ///< a name, "none", or empty for the scene's first
};

/// A scene as the command line asks for it.
struct LoadedScene {
  scene::Robot robot;
  std::string controller;  ///< to be attached; empty for none
};

/// Reads, builds and prints the warnings. Throws what scene::load() does, and Error(unknown-name)
/// for a controller that the scene does not have.
/// @param options see there.
LoadedScene load_scene(const SceneOptions& options);

/// A robot, one simulation of it, and the controller that steers it.
class Session {
 public:
  /// Reads, builds, prints the warnings and attaches. Throws what scene::load() does, and
  /// Error(unknown-name) for a controller that the scene does not have.
  /// @param options see there.
  explicit Session(const SceneOptions& options);

  const scene::Robot& robot() const { return robot_; }
  sim::Simulation& simulation() { return *simulation_; }
  /// Null when nothing steers.
  const inverse::TargetController* controller() const { return controller_.get(); }
  const std::string& controller_name() const { return controller_name_; }
  void step() { simulation_->step(); }

  /// When the first turn of all targets is over, s; 0 without any that move.
  double first_turn() const;
  /// The largest distance of an effector from its target, m or rad; 0 without a controller.
  double error() const { return controller_ ? controller_->error() : 0.0; }
  /// The scene as resolved: overrides applied, paths absolute; YAML.
  std::string resolved_scene() const;

 private:
  scene::Robot robot_;
  std::filesystem::path folder_;
  std::unique_ptr<sim::Simulation> simulation_;
  std::string controller_name_;
  std::unique_ptr<inverse::TargetController> controller_;
};

/// While the result lives, Ctrl-C ends the step in hand (by Interrupted, see terminal.hpp), and
/// steps that take more than two seconds are told of.
/// All outlive it. @param bar tells. @param done the steps that it counts.
sim::Watched watch_steps(sim::Simulation& simulation, ProgressBar& bar, const std::int64_t& done);

/// Adds SCENE (which must be given unless `optional`), --set, --threads and --controller to a
/// command.
/// @param command to add to. @param options to fill.
void add_scene_options(Command& command, SceneOptions& options, bool optional = false);

}  // namespace sinew::cli
