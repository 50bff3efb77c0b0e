#include "live_source.hpp"

namespace sinew::viewer {

LiveSource::LiveSource(scene::Robot robot, const LiveSettings& settings)
    : SourceThread(settings.playing, settings.speed),
      state_(std::move(robot), settings.controller) {}

bool LiveSource::advance() {
  state_.step();
  return !state_.stopped();
}

void LiveSource::require_ready() const {
  if (!state_.stopped()) return;
  throw Error(ErrorKind::diverged, {}, "the run has stopped: " + state_.stopped()->message,
              "reset it first");
}

void LiveSource::handle(const Request& request) {
  if (std::holds_alternative<Reset>(request)) {
    state_.reset();
    restart_clock();
  } else if (std::holds_alternative<Settle>(request)) {
    state_.settle();
  } else if (const auto* command = std::get_if<SetCommand>(&request)) {
    state_.command(*command);
  } else if (const auto* controller = std::get_if<ChooseController>(&request)) {
    state_.choose_controller(controller->name);
  } else if (const auto* target = std::get_if<SetTarget>(&request)) {
    state_.set_target(*target);
  } else if (const auto* pull = std::get_if<Pull>(&request)) {
    state_.pull(*pull);
  } else if (std::holds_alternative<Release>(request)) {
    state_.release();
  } else {
    throw Error(ErrorKind::not_in_this_version, {}, "a live robot cannot do this",
                "see docs/view.md for what it can");
  }
}

}  // namespace sinew::viewer
