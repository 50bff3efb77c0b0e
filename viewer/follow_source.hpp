/// @file
/// Shows a robot that a script steps, and lets a browser interact with it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "live_source.hpp"

namespace sinew::viewer {

/// A source whose simulation is stepped by a script. The script and the source take turns. After
/// hand_over(), the source carries out requests of browsers and makes a frame. It then returns the
/// turn, unless the page has paused it or the clock is not there yet. During its turn, the script
/// has exclusive use of the simulation.
class FollowSource final : public LiveSource {
 public:
  /// @param robot,simulation to be shown. @param settings whose controller is not used.
  FollowSource(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
               const LiveSettings& settings);
  ~FollowSource() override { FollowSource::stop(); }

  std::string_view mode() const override { return "follow"; }
  void stop() override;

  // Functions for the script, called from one thread.

  /// Sets the controller that is shown, see RobotState::observe(). Call it before hand_over().
  void observe(const std::string& name, control::TargetController* controller) {
    state().observe(name, controller);
  }
  /// Starts the turn of the source.
  void hand_over();
  /// Waits until the turn of the source ends; false if it has not ended within the time. The first
  /// turn, in which the first frame is made, starts with start().
  bool wait_turn(std::chrono::milliseconds time);
  /// Whether the source was stopped.
  bool ended() const;

 protected:
  void begin() override { static_cast<void>(script_turn()); }
  bool advance() override;
  void handle(const Request& request) override;

 private:
  bool script_turn();

  mutable std::mutex turn_mutex_;  // protects the next two members
  bool of_script_ = false, ended_ = false;
  std::condition_variable turn_;
};

}  // namespace sinew::viewer
