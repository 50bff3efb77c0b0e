/// @file
/// A running robot, driven by a browser.
#pragma once

#include <memory>
#include <string>

#include "sinew/scene/build.hpp"

#include "source.hpp"

namespace sinew::viewer {

struct LiveSettings {
  std::string controller;  ///< attached at the start: a name of the scene's, or empty for none
  bool playing = true;
  double speed = 1.0;  ///< simulated seconds a second; 0: as fast as it can
};

/// Steps a simulation in a thread of its own: in time with the clock, or as fast as it can.
class LiveSource final : public Source {
 public:
  /// @param robot is simulated with its own threads. @param settings see there.
  /// Throws Error(unknown-name) for a controller that the scene does not have.
  LiveSource(scene::Robot robot, const LiveSettings& settings = {});
  ~LiveSource() override;

  std::string_view mode() const override { return "live"; }
  const Description& description() const override;
  void start(Publisher& publisher) override;
  void stop() override;
  void submit(const Request& request, std::function<void(Outcome)> done) override;
  void fetch(std::string_view name, std::function<void(std::optional<Download>)> done) override;

 private:
  class Runner;
  std::unique_ptr<Runner> runner_;
};

}  // namespace sinew::viewer
