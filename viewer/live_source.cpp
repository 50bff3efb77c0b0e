#include "live_source.hpp"

#include <boost/asio/post.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/model/model.hpp"

namespace sinew::viewer {

LiveSource::LiveSource(const scene::Robot& robot, const LiveSettings& settings)
    : LiveSource(robot, std::make_shared<sim::Simulation>(robot.model, robot.threads()),
                 settings.controller.empty() ? std::nullopt
                                             : std::optional(robot.controller(settings.controller)),
                 settings) {}

LiveSource::LiveSource(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
                       std::optional<scene::SceneController> first, const LiveSettings& settings)
    : SourceThread(settings.playing, settings.speed),
      state_(std::move(robot), std::move(simulation), std::move(first)),
      description_(state_.description()),
      gallery_(settings.gallery) {
  state_.follow();
  auto scene = nlohmann::json::parse(description_.scene);
  scene["gallery"] = static_cast<bool>(gallery_);
  description_.scene = scene.dump();
}

void LiveSource::stop() {
  end();
  writer_.join();
}

bool LiveSource::complete(void (RobotState::*work)()) {
  struct Ended {};
  const sim::Watched watched = state_.watch([this](const run::StepProgress&) {
    if (stopping()) throw Ended{};
  });
  try {
    (state_.*work)();
  } catch (const Ended&) {
    return false;
  }
  return true;
}

bool LiveSource::advance() {
  timeline_.go_on();
  if (!complete(&RobotState::step) || state_.stopped()) return false;
  if (timeline_.due(time())) timeline_.keep(state_.moment());
  record();
  return true;
}

std::shared_ptr<const Frame> LiveSource::frame(const FrameWishes& wishes, double real_time_factor) {
  std::shared_ptr<Frame> frame = state_.frame(wishes, real_time_factor);
  if (!timeline_.empty()) frame->timeline = timeline_.describe(time());
  return frame;
}

// The current state becomes the latest moment, so that the user can return to it.
void LiveSource::go_back(std::int64_t number) {
  if (timeline_.empty()) {
    throw Error(ErrorKind::not_in_this_version, {}, "a script steps this robot",
                "load a saved state in the script");
  }
  if (!timeline_.in_past()) timeline_.keep(state_.moment());
  const Moment& moment = timeline_.go_back(number);
  record(false);
  pause();
  state_.go_back(moment);
  restart_clock();
}

void LiveSource::require_ready() const {
  if (!state_.stopped()) return;
  throw Error(
      ErrorKind::diverged, {}, "the run has stopped: " + state_.stopped()->message,
      "the robot is in its last solved state: change a command and go on, or go back in time");
}

void LiveSource::record() {
  if (!recording_on_) return;
  if (!recording_->add(*state_.frame({}, 0.0))) record(false);
}

void LiveSource::record(bool on) {
  if (on) {
    recording_ = std::make_shared<Recording>(description_, state_.robot().description.name);
    recording_on_ = true;
    return record();
  }
  if (!recording_on_) return;
  recording_on_ = false;
  const std::lock_guard lock(mutex_);
  saved_ = recording_;
}

void LiveSource::fetch(std::string_view name, std::function<void(std::optional<Download>)> done) {
  std::shared_ptr<const Recording> saved;
  {
    const std::lock_guard lock(mutex_);
    saved = saved_;
  }
  const bool table = name == "run.csv";
  if (!saved || (!table && name != "motion.glb")) return done(std::nullopt);
  boost::asio::post(writer_, [saved, table, done = std::move(done)] {
    try {
      done(table ? Download{"run.csv", "text/csv; charset=utf-8", saved->csv()}
                 : Download{"motion.glb", "model/gltf-binary", saved->glb()});
    } catch (const std::exception&) {
      done(std::nullopt);  // the motion is too long for one file, or memory is exhausted
    }
  });
}

std::string LiveSource::status_members() const {
  const std::string recording =
      recording_ ? fmt::format(R"({{"on":{},"frames":{},"seconds":{:.3f},"bytes":{},"full":{}}})",
                               recording_on_, recording_->rows(), recording_->seconds(),
                               recording_->bytes(), recording_->full())
                 : "null";
  return fmt::format(R"({{"recording":{},{})", recording, state_.status_members().substr(1));
}

void LiveSource::handle(const Request& request) {
  if (std::holds_alternative<Reset>(request)) {
    record(false);
    state_.reset();
    timeline_.clear();
    timeline_.keep(state_.moment());
    restart_clock();
  } else if (std::holds_alternative<Settle>(request)) {
    if (!complete(&RobotState::settle)) {
      throw Error(ErrorKind::not_converged, {}, "the view ended before an equilibrium was found",
                  "open it again");
    }
    timeline_.keep(state_.moment());
  } else if (const auto* seek = std::get_if<Seek>(&request)) {
    go_back(seek->frame);
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
  } else if (const auto* recording = std::get_if<Record>(&request)) {
    record(recording->on);
  } else if (std::holds_alternative<ShowGallery>(request) && gallery_) {
    publisher().replace(gallery_);
  } else {
    throw Error(ErrorKind::not_in_this_version, {}, "a live robot cannot do this",
                "see docs/view.md for what it can");
  }
}

}  // namespace sinew::viewer
