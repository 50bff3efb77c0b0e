/// @file
/// A running robot, driven by a browser.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include <boost/asio/thread_pool.hpp>

#include "sinew/scene/build.hpp"

#include "recording.hpp"
#include "robot_state.hpp"
#include "source_thread.hpp"
#include "timeline.hpp"

namespace sinew::viewer {

struct LiveSettings {
  std::string controller;  ///< attached at the start: a name of the scene's, or empty for none
  bool playing = true;
  double speed = 1.0;  ///< simulated seconds a second; 0: as fast as it can
  /// Where the page goes back to; none: nowhere.
  std::function<std::unique_ptr<Source>()> gallery;
};

/// Steps a simulation, and records it when asked to.
class LiveSource : public SourceThread {
 public:
  /// @param robot is simulated with its own threads. @param settings see there.
  /// Throws Error(unknown-name) for a controller that the scene does not have.
  explicit LiveSource(const scene::Robot& robot, const LiveSettings& settings = {});
  /// A simulation that others own and leave alone between start() and stop().
  /// @param robot,simulation what is shown. @param first,settings the one in place of the
  ///   other's controller.
  LiveSource(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
             std::optional<scene::SceneController> first, const LiveSettings& settings);
  ~LiveSource() override { LiveSource::stop(); }

  std::string_view mode() const override { return "live"; }
  const Description& description() const override { return description_; }
  void stop() override;
  /// "run.csv" and "motion.glb" of what was recorded, once the recording has ended.
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override;

  /// As RobotState's; only while the source does not run.
  auto take_controller() { return state_.take_controller(); }

 protected:
  double time() const override { return state_.simulation().time(); }
  double time_step() const override { return state_.time_step(); }
  bool advance() override;
  void handle(const Request& request) override;
  void require_ready() const override;
  void begin() override { timeline_.keep(state_.moment()); }
  std::shared_ptr<const Frame> frame(const FrameWishes& wishes, double real_time_factor) override;
  std::string status_members() const override;

  RobotState& state() { return state_; }
  /// Appends the present state, when recording.
  void record();

 private:
  /// Whether a step or a search came to its end: not where the source is to stop meanwhile. The
  /// state is then that before it.
  bool complete(void (RobotState::*work)());
  void record(bool on);
  void go_back(std::int64_t number);

  RobotState state_;
  Timeline timeline_;  ///< empty where a script steps
  Description description_;
  std::function<std::unique_ptr<Source>()> gallery_;
  std::shared_ptr<Recording> recording_;  ///< under way, or ended
  bool recording_on_ = false;
  std::mutex mutex_;  // of saved_
  std::shared_ptr<const Recording> saved_;
  boost::asio::thread_pool writer_{1};  ///< makes files of what was recorded
};

}  // namespace sinew::viewer
