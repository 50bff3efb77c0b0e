/// @file
/// A simulation with its controllers and the interactions of a browser. Makes frames. Not
/// thread-safe: one thread owns it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sinew/control/controller_observables.hpp"
#include "sinew/control/target_controller.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/watched.hpp"

#include "describe.hpp"
#include "frame.hpp"
#include "frame_maker.hpp"
#include "message.hpp"
#include "playback.hpp"
#include "timeline.hpp"

namespace sinew::viewer {

/// Why a run stopped early.
struct StoppedRun {
  std::int64_t step = 0;
  std::string kind, message, remedy;
  /// Places and displacements of nodes in a motion that nothing resists, m; the largest is a
  /// fraction of the robot's size. Empty unless that is why.
  std::vector<std::pair<Vector3, Vector3>> free_motion;
};

/// The state of a robot in the view.
class RobotState {
 public:
  /// @param robot to be shown. @param simulation of the robot; the destructor removes the mouse
  /// spring from it. @param first controller attached now and by reset(); its targets may differ
  /// from those of the scene.
  RobotState(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
             std::optional<scene::SceneController> first);
  /// Makes a simulation of its own, without controller.
  explicit RobotState(const scene::Robot& robot)
      : RobotState(robot, std::make_shared<sim::Simulation>(robot.model, robot.threads()), {}) {}
  ~RobotState();
  RobotState(const RobotState&) = delete;
  RobotState& operator=(const RobotState&) = delete;

  const Description& description() const { return description_; }
  const scene::Robot& robot() const { return robot_; }
  const sim::Simulation& simulation() const { return *simulation_; }
  double time_step() const { return simulation_->model().step().time_step; }
  const std::optional<StoppedRun>& stopped() const { return stopped_; }
  /// Forgets why the run stopped. The robot is in its last solved state, from which the next step
  /// begins.
  void try_again() { stopped_.reset(); }
  /// The observables of the simulation, the controller and the real-time factor. In a replay they
  /// have the recorded values.
  sim::Observables& observables() { return observables_; }

  /// Lets quasi-static steps follow as long as this exists, see sim::Simulation::follow().
  void follow();
  /// Advances one step. If it throws Error, keeps that as stopped().
  void step();
  /// While the result exists, step() and settle() report their progress to `watcher`.
  sim::Watched watch(run::StepWatcher watcher) { return {*simulation_, std::move(watcher)}; }
  /// Call it after other code has stepped the simulation.
  void moved() { ++shape_; }
  /// Shows a controller that other code attaches and detaches. From now on, none is attached here.
  /// @param name,controller to be shown; null: there is none.
  void observe(const std::string& name, control::TargetController* controller);
  /// Releases ownership of the controller, which stays attached. Returns it with its name.
  std::pair<std::string, std::unique_ptr<control::TargetController>> take_controller();
  void reset();
  void settle();
  void command(const SetCommand& command);
  void choose_controller(const std::optional<std::string>& name);
  void set_target(const SetTarget& target);
  /// See Playback::show().
  void show(const RecordedState& recorded);
  void pull(const Pull& pull);
  void release();
  /// The current moment, for go_back().
  Moment moment();
  /// Restores the state, commands, controller and targets of a moment, and releases the mouse
  /// spring. The run then continues as it did before, bit for bit.
  void go_back(const Moment& moment);

  /// Makes a frame of the current state.
  /// @param wishes parts of the frame besides positions. @param real_time_factor signal; NaN: none.
  std::shared_ptr<Frame> frame(const FrameWishes& wishes, double real_time_factor);
  /// JSON object with the members of the status message that belong to the robot: controller,
  /// commands, targets, troubles, stopped.
  std::string status_members() const;

 private:
  void attach(const std::string& name, const control::ControllerSettings& settings);
  void detach();
  void stop(const Error& error);
  std::shared_ptr<const Acting> acting();
  int task_of(int effector) const { return control::task_of(controller_, effector); }
  sim::Observables list_observables();

  scene::Robot robot_;
  std::shared_ptr<sim::Simulation> simulation_;
  std::unique_ptr<control::TargetController> own_;
  control::TargetController* controller_ = nullptr;  ///< own_, or an observed one
  std::string controller_name_;
  sim::Observables observables_;
  Description description_;
  Playback playback_;
  FrameMaker frames_;
  double real_time_factor_ = 0.0;
  std::optional<bool> followed_before_;  // see follow()
  std::optional<scene::SceneController> first_;
  bool observing_ = false;
  std::map<std::string, Vector3> targets_;
  std::optional<int> pulled_;             ///< body with the mouse spring
  std::shared_ptr<const Acting> acting_;  ///< null if changed since the last moment()
  std::optional<StoppedRun> stopped_;
  std::uint64_t shape_ = 0;
};

}  // namespace sinew::viewer
