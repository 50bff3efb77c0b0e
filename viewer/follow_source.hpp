/// @file
/// A robot that a script steps, seen and helped from a browser.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "live_source.hpp"

namespace sinew::viewer {

/// The script and the source take turns: in hand_over() the source carries out what browsers asked
/// for and makes a frame; it then lets the script go on, unless the page has paused it or the clock
/// is not there yet. Outside of these turns the simulation is the script's alone.
class FollowSource final : public LiveSource {
 public:
  /// @param robot,simulation what is shown. @param settings controller and gallery are not used.
  FollowSource(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
               const LiveSettings& settings);
  ~FollowSource() override { FollowSource::stop(); }

  std::string_view mode() const override { return "follow"; }
  void stop() override;

  // The script's side; of one thread.

  /// The controller that is to be shown; see RobotState. Before hand_over().
  void observe(const std::string& name, inverse::TargetController* controller) {
    state().observe(name, controller);
  }
  /// Begins the source's turn.
  void hand_over();
  /// Waits for its end; the first turn, in which a first frame is made, begins with start(). False
  /// when it has not ended within the time.
  bool wait_turn(std::chrono::milliseconds time);
  /// Whether the source was stopped.
  bool ended() const;

 protected:
  void begin() override { static_cast<void>(script_turn()); }
  bool advance() override;
  void handle(const Request& request) override;

 private:
  bool script_turn();

  mutable std::mutex turn_mutex_;  // of the next two
  bool of_script_ = false, ended_ = false;
  std::condition_variable turn_;
};

}  // namespace sinew::viewer
