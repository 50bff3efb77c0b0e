#include "follow_source.hpp"

namespace sinew::viewer {

FollowSource::FollowSource(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
                           const LiveSettings& settings)
    : LiveSource(std::move(robot), std::move(simulation), std::nullopt, settings) {
  state().observe({}, nullptr);
}

void FollowSource::stop() {
  {
    const std::lock_guard lock(turn_mutex_);
    ended_ = true;
  }
  turn_.notify_all();
  LiveSource::stop();
}

void FollowSource::hand_over() {
  {
    const std::lock_guard lock(turn_mutex_);
    of_script_ = false;
  }
  turn_.notify_all();
}

bool FollowSource::wait_turn(std::chrono::milliseconds time) {
  std::unique_lock lock(turn_mutex_);
  return turn_.wait_for(lock, time, [this] { return of_script_ || ended_; });
}

bool FollowSource::ended() const {
  const std::lock_guard lock(turn_mutex_);
  return ended_;
}

bool FollowSource::script_turn() {
  std::unique_lock lock(turn_mutex_);
  of_script_ = true;
  turn_.notify_all();
  turn_.wait(lock, [this] { return !of_script_ || ended_; });
  return !ended_;
}

bool FollowSource::advance() {
  if (!script_turn()) {
    state().observe({}, nullptr);  // the script's controller may be gone
    return false;
  }
  state().moved();
  record();
  return true;
}

void FollowSource::handle(const Request& request) {
  if (std::holds_alternative<Reset>(request) || std::holds_alternative<Settle>(request)) {
    throw Error(ErrorKind::not_in_this_version, {}, "a script steps this robot",
                "let the script do this");
  }
  LiveSource::handle(request);
}

}  // namespace sinew::viewer
