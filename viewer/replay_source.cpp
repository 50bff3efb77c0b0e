#include "replay_source.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/mechanics/body.hpp"
#include "sinew/scene/scene.hpp"

#include "limits.hpp"
#include "recording.hpp"

namespace sinew::viewer {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path file_of(const fs::path& path) { return fs::is_directory(path) ? path / "run.h5" : path; }

scene::Robot recorded_robot(const record::RunFile& file) {
  if (!file.has_states()) {
    throw Error(ErrorKind::missing_key, {.item = "record.states"},
                "this run was recorded without states, so that there is nothing to see",
                "record it with `record: {states: true}`");
  }
  if (file.frames() == 0) {
    throw Error(ErrorKind::empty_list, {.item = "run.h5"}, "the run has no frames", "run it again");
  }
  return scene::build(scene::parse_scene_text(file.scene(), file.scene_name(), {}));
}

}  // namespace

bool is_recorded_run(const fs::path& path) {
  std::error_code problem;
  if (fs::is_directory(path, problem)) return fs::exists(path / "run.h5", problem);
  return record::RunFile::is_hdf5(path);
}

ReplaySource::ReplaySource(const fs::path& path, bool playing, double speed)
    : SourceThread(playing, speed),
      folder_(file_of(path).parent_path()),
      file_(file_of(path)),
      state_(recorded_robot(file_)),
      description_(state_.description()) {
  for (const sim::ActuatorModel& actuator : state_.simulation().model().actuators()) {
    efforts_.push_back(file_.actuator(actuator.name, "effort"));
    motions_.push_back(file_.actuator(actuator.name, "motion"));
  }
  Json scene = Json::parse(description_.scene);
  scene["frames"] = file_.frames();
  scene["duration"] = file_.times().back();
  description_.scene = scene.dump();
  show();
}

double ReplaySource::time_step() const {
  const auto next = static_cast<std::size_t>(std::min(at_ + 1, file_.frames() - 1));
  return std::max(file_.times()[next] - time(), 1e-6);
}

bool ReplaySource::advance() {
  if (at_ + 1 >= file_.frames()) return false;
  ++at_;
  show();
  return true;
}

void ReplaySource::require_ready() const {
  if (at_ + 1 < file_.frames()) return;
  throw Error(ErrorKind::out_of_range, {}, "this is the end of the recorded run",
              "seek an earlier frame, or reset");
}

void ReplaySource::handle(const Request& request) {
  if (const auto* seek = std::get_if<Seek>(&request)) {
    at_ = std::min(seek->frame, file_.frames() - 1);
  } else if (std::holds_alternative<Reset>(request)) {
    at_ = 0;
  } else if (std::holds_alternative<Release>(request)) {
    return;
  } else {
    throw Error(ErrorKind::not_in_this_version, {}, "a recorded run cannot be changed",
                "see its scene live: sinew view scene.yaml");
  }
  show();
  restart_clock();
}

void ReplaySource::show() {
  RecordedState recorded;
  for (const auto& body : state_.simulation().model().bodies()) {
    recorded.positions.push_back(file_.positions(body->name(), at_));
    recorded.coordinates.push_back(file_.coordinates(body->name(), at_));
  }
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    recorded.efforts.push_back(efforts_[i][static_cast<std::size_t>(at_)]);
    recorded.motions.push_back(motions_[i][static_cast<std::size_t>(at_)]);
  }
  if (!file_.contacts().empty()) {
    for (const sim::ContactModel& contact : state_.simulation().model().contacts()) {
      recorded.contacts.push_back(file_.contact(contact.name, at_));
    }
  }
  recorded.step = std::llround(time() / state_.time_step());
  state_.show(recorded);
}

std::shared_ptr<const Frame> ReplaySource::frame(const FieldChoice& wanted,
                                                 double real_time_factor) {
  return state_.frame(wanted, real_time_factor);
}

std::string ReplaySource::status_members() const {
  return fmt::format(R"({{"frame":{},{})", at_, state_.status_members().substr(1));
}

// At most as many frames as the motion keeps.
std::string ReplaySource::motion() {
  Recording recording(description_, state_.robot().description.name);
  const std::int64_t shown = at_, frames = file_.frames();
  const std::int64_t stride = 1 + (frames - 1) / static_cast<std::int64_t>(limits::kMotionFrames);
  for (at_ = 0; at_ < frames; at_ += stride) {
    show();
    static_cast<void>(recording.add(*state_.frame({}, 0.0)));
  }
  at_ = shown;
  show();
  return recording.glb();
}

// The run's own table, or its motion; nothing else of its folder.
std::optional<Download> ReplaySource::download(std::string_view name) {
  if (name == "motion.glb") return Download{"motion.glb", "model/gltf-binary", motion()};
  if (name != "run.csv") return std::nullopt;
  std::ifstream file(folder_ / "run.csv", std::ios::binary);
  if (!file) return std::nullopt;
  return Download{"run.csv",
                  "text/csv; charset=utf-8",
                  {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}};
}

}  // namespace sinew::viewer
