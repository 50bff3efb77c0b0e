/// @file
/// A simulation with its controllers and what a browser has done to it; makes frames of it. Not
/// thread-safe: one thread owns it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sinew/inverse/controller_observables.hpp"
#include "sinew/inverse/target_controller.hpp"
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

/// Why a run ended before its time.
struct StoppedRun {
  std::int64_t step = 0;
  std::string kind, message, remedy;
};

class RobotState {
 public:
  /// @param robot,simulation what is shown, and what steps; a hand's spring is taken off it at the
  ///   end. @param first attached now and by reset(); its targets need not be
  ///   the scene's.
  RobotState(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
             std::optional<scene::SceneController> first);
  /// A simulation of its own, which nothing steers.
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
  /// What is shown in numbers: of the simulation, of its controller and the real-time factor. In a
  /// replay, what was recorded.
  sim::Observables& observables() { return observables_; }

  /// One step; what it throws is kept as stopped().
  void step();
  /// While the result lives, step() and settle() tell how far they are.
  sim::Watched watch(sim::StepWatcher watcher) { return {*simulation_, std::move(watcher)}; }
  /// The simulation was stepped by others.
  void moved() { ++shape_; }
  /// Shows a controller that others attach and detach: from now on none is attached here.
  /// @param name,controller null: nothing steers.
  void observe(const std::string& name, inverse::TargetController* controller);
  /// The controller that is attached, with its name: it stays attached.
  std::pair<std::string, std::unique_ptr<inverse::TargetController>> take_controller();
  void reset();
  void settle();
  void command(const SetCommand& command);
  void choose_controller(const std::optional<std::string>& name);
  void set_target(const SetTarget& target);
  /// Playback::show().
  void show(const RecordedState& recorded);
  void pull(const Pull& pull);
  void release();
  /// The present moment, to come back to.
  Moment moment();
  /// Back to a moment: its state, commands, controller and targets, after which the run goes on bit
  /// for bit as it did. The hand lets go.
  void go_back(const Moment& moment);

  /// Everything that is to be seen now.
  /// @param wishes beside positions. @param real_time_factor is among the signals; NaN: none.
  std::shared_ptr<Frame> frame(const FrameWishes& wishes, double real_time_factor);
  /// JSON of the status message without what the source itself knows: controller, commands,
  /// targets, troubles, stopped.
  std::string status_members() const;

 private:
  void attach(const std::string& name, const inverse::InverseSettings& settings);
  void detach();
  std::shared_ptr<const Acting> acting();
  int task_of(int effector) const { return inverse::task_of(controller_, effector); }
  sim::Observables list_observables();

  scene::Robot robot_;
  std::shared_ptr<sim::Simulation> simulation_;
  sim::Observables observables_;
  Description description_;
  Playback playback_;
  FrameMaker frames_;
  double real_time_factor_ = 0.0;
  std::unique_ptr<inverse::TargetController> own_;
  inverse::TargetController* controller_ = nullptr;  ///< own_, or one that others look after
  std::string controller_name_;
  std::optional<scene::SceneController> first_;
  bool observing_ = false;
  std::map<std::string, Vector3> targets_;
  std::optional<int> pulled_;             ///< body
  std::shared_ptr<const Acting> acting_;  ///< null: changed since it was last asked for
  std::optional<StoppedRun> stopped_;
  std::uint64_t shape_ = 0;
};

}  // namespace sinew::viewer
