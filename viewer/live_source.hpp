/// @file
/// Shows a running simulation, controlled by a browser.
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

/// Settings of a LiveSource.
struct LiveSettings {
  std::string controller;  ///< attached initially: a name in the scene, or empty for none
  bool playing = true;
  double speed = 1.0;  ///< simulated seconds per second; 0: as fast as possible
  /// Makes the gallery to which the page can return; none: there is no gallery.
  std::function<std::unique_ptr<Source>()> gallery;
};

/// A source that steps a simulation, and records it on request.
class LiveSource : public SourceThread {
 public:
  /// Makes a simulation with the number of threads of the robot. Throws Error(unknown-name) for an
  /// unknown controller. @param robot to be simulated. @param settings of the source.
  explicit LiveSource(const scene::Robot& robot, const LiveSettings& settings = {});
  /// Uses a simulation that its owner does not touch between start() and stop().
  /// @param robot,simulation to be shown. @param first controller attached initially; replaces that
  /// of `settings`. @param settings of the source.
  LiveSource(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
             std::optional<scene::SceneController> first, const LiveSettings& settings);
  ~LiveSource() override { LiveSource::stop(); }

  std::string_view mode() const override { return "live"; }
  const Description& description() const override { return description_; }
  void stop() override;
  /// Provides "run.csv" and "motion.glb" of a recording, once it has ended.
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override;

  /// See RobotState::take_controller(). Call it only while the source is not running.
  auto take_controller() { return state_.take_controller(); }

 protected:
  double time() const override { return state_.simulation().time(); }
  double time_step() const override { return state_.time_step(); }
  bool advance() override;
  void handle(const Request& request) override;
  void require_ready() const override;
  void try_again() override { state_.try_again(); }
  void begin() override { timeline_.keep(state_.moment()); }
  std::shared_ptr<const Frame> frame(const FrameWishes& wishes, double real_time_factor) override;
  std::string status_members() const override;

  RobotState& state() { return state_; }
  /// Appends the current state to the recording, if it is on.
  void record();

 private:
  /// Runs a step or solver. Returns false if the source is stopped meanwhile; the state is then
  /// that before the call.
  bool complete(void (RobotState::*work)());
  void record(bool on);
  void go_back(std::int64_t number);

  RobotState state_;
  Timeline timeline_;  ///< empty if a script steps
  Description description_;
  std::function<std::unique_ptr<Source>()> gallery_;
  std::shared_ptr<Recording> recording_;  ///< running or ended
  bool recording_on_ = false;
  std::mutex mutex_;  // protects saved_
  std::shared_ptr<const Recording> saved_;
  boost::asio::thread_pool writer_{1};  ///< makes files of recordings
};

}  // namespace sinew::viewer
