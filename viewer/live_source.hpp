/// @file
/// A running robot, driven by a browser.
#pragma once

#include <memory>
#include <string>

#include "sinew/scene/build.hpp"

#include "robot_state.hpp"
#include "source_thread.hpp"

namespace sinew::viewer {

struct LiveSettings {
  std::string controller;  ///< attached at the start: a name of the scene's, or empty for none
  bool playing = true;
  double speed = 1.0;  ///< simulated seconds a second; 0: as fast as it can
};

/// Steps a simulation.
class LiveSource final : public SourceThread {
 public:
  /// @param robot is simulated with its own threads. @param settings see there.
  /// Throws Error(unknown-name) for a controller that the scene does not have.
  explicit LiveSource(scene::Robot robot, const LiveSettings& settings = {});
  ~LiveSource() override { end(); }

  std::string_view mode() const override { return "live"; }
  const Description& description() const override { return state_.description(); }

 protected:
  double time() const override { return state_.simulation().time(); }
  double time_step() const override { return state_.time_step(); }
  bool advance() override;
  void handle(const Request& request) override;
  void require_ready() const override;
  std::shared_ptr<const Frame> frame(const std::array<bool, kFieldCount>& wanted,
                                     double real_time_factor) override {
    return state_.frame(wanted, real_time_factor);
  }
  std::string status_members() const override { return state_.status_members(); }

 private:
  RobotState state_;
};

}  // namespace sinew::viewer
