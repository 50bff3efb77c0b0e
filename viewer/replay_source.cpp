#include "replay_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/whole.hpp"
#include "sinew/record/run_layout.hpp"
#include "sinew/scene/body_kind.hpp"
#include "sinew/scene/scene.hpp"

#include "recording.hpp"

namespace sinew::viewer {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path file_of(const fs::path& path) { return fs::is_directory(path) ? path / "run.h5" : path; }

// Whether a state cannot be shown without an observable. All formats have these.
bool is_needed(const run::Observable& observable) {
  switch (observable.kind) {
    case run::ObservableKind::body:
    case run::ObservableKind::effector:
    case run::ObservableKind::probe:
    case run::ObservableKind::contact_point:
      return true;
    case run::ObservableKind::actuator:
      return observable.quantity == "effort" || observable.quantity == "motion";
    default:
      return false;
  }
}

// The default element of a material may have become quadratic since the run was recorded: bodies
// keep the linear tetrahedra that the file has.
void keep_linear_elements(const record::RunFile& file, scene::SceneDescription& description) {
  for (scene::BodyDescription& body : description.bodies) {
    const bool is_default = body.element == scene::Element::any && body.kind->has_elements &&
                            std::ranges::find(file.bodies(), body.name) != file.bodies().end();
    if (!is_default) continue;
    const mesh::Mesh mesh = file.rest_mesh(body.name);
    const bool linear = !mesh.tetrahedra.empty() && mesh.quadratic.empty();
    if (linear && mesh.hexahedra.empty()) body.element = scene::Element::tet4;
  }
}

scene::Robot recorded_robot(const record::RunFile& file) {
  if (!file.has_states()) {
    throw Error(ErrorKind::missing_key, {.item = "record.states"},
                "this run was recorded without states, so that there is nothing to see",
                "record it with `record: {states: true}`");
  }
  if (file.frames() == 0) {
    throw Error(ErrorKind::empty_list, {.item = "run.h5"}, "the run has no frames", "run it again");
  }
  scene::SceneDescription description =
      scene::parse_recorded_scene(file.scene(), file.scene_name());
  keep_linear_elements(file, description);
  return scene::build(std::move(description));
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
  open_series();
  Json scene = Json::parse(description_.scene);
  scene["frames"] = file_.frames();
  scene["duration"] = file_.times().back();
  if (!file_.lacks().empty()) {
    scene["notices"].push_back({{"level", "remark"},
                                {"kind", "older-recording"},
                                {"subject", "run.h5"},
                                {"text", "this run was " + file_.lacks()},
                                {"remedy", "run its scene again to have them"}});
  }
  description_.scene = scene.dump();
  show();
}

void ReplaySource::open_series() {
  constexpr std::size_t kSmall = 16;
  const std::vector<run::Observable>& list = state_.observables().list();
  for (std::size_t k = 0; k < list.size(); ++k) {
    std::string dataset = record::dataset_of(list[k]);
    if (dataset.empty()) continue;
    if (!file_.has(dataset)) {
      if (!is_needed(list[k])) continue;
      throw Error(ErrorKind::malformed_file, {.item = "run.h5"},
                  fmt::format("{} is missing", dataset), "record the run again");
    }
    std::vector<double> small;
    if (list[k].size() <= kSmall) small = file_.series(dataset);
    series_.push_back({k, std::move(dataset), std::move(small)});
  }
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
  for (const Series& one : series_) {
    RecordedState::Value value{one.observable, {}};
    if (one.small.empty()) {
      value.numbers = file_.numbers(one.dataset, at_);
    } else {
      const auto size = one.small.size() / static_cast<std::size_t>(file_.frames());
      const auto first = one.small.begin() + static_cast<std::ptrdiff_t>(size) * at_;
      value.numbers.assign(first, first + static_cast<std::ptrdiff_t>(size));
    }
    recorded.values.push_back(std::move(value));
  }
  recorded.step = whole<std::int64_t>(std::round(time() / state_.time_step()));
  state_.show(recorded);
}

std::shared_ptr<const Frame> ReplaySource::frame(const FrameWishes& wishes,
                                                 double real_time_factor) {
  return state_.frame(wishes, real_time_factor);
}

std::string ReplaySource::status_members() const {
  return fmt::format(R"({{"frame":{},{})", at_, state_.status_members().substr(1));
}

// Reads at most as many frames as the motion keeps.
std::string ReplaySource::motion() {
  Recording recording(description_, state_.robot().description.name);
  const std::int64_t shown = at_, frames = file_.frames();
  const std::int64_t stride = 1 + (frames - 1) / static_cast<std::int64_t>(record::kMotionFrames);
  for (at_ = 0; at_ < frames; at_ += stride) {
    show();
    static_cast<void>(recording.add(*state_.frame({}, 0.0)));
  }
  at_ = shown;
  show();
  return recording.glb();
}

// The signals of all frames, or of every k-th one of a long run; the format is in
// docs/view_protocol.md. A signal that was not recorded is NaN.
std::string ReplaySource::history() {
  constexpr std::size_t kMostNumbers = 4'000'000;
  const auto frames = static_cast<std::size_t>(file_.frames());
  const std::size_t signals = description_.signals.size();
  const std::size_t stride = 1 + frames * signals / kMostNumbers;
  std::vector<double> times;
  for (std::size_t k = 0; k < frames; k += stride) times.push_back(file_.times()[k]);
  std::vector<float> numbers(times.size() * signals, std::numeric_limits<float>::quiet_NaN());
  std::size_t first = 0;  // signal of the observable
  const std::vector<run::Observable>& list = state_.observables().list();
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (!is_signal(list[k])) continue;
    const std::size_t size = list[k].size();
    const auto series = std::ranges::find(series_, k, &Series::observable);
    const bool known = series != series_.end() && series->small.size() == frames * size;
    for (std::size_t c = 0; known && c < size; ++c) {
      for (std::size_t i = 0; i < times.size(); ++i) {
        numbers[(first + c) * times.size() + i] =
            static_cast<float>(series->small[i * stride * size + c]);
      }
    }
    first += size;
  }
  const std::array<std::uint32_t, 2> head = {static_cast<std::uint32_t>(times.size()),
                                             static_cast<std::uint32_t>(signals)};
  std::string bytes;
  const auto append = [&bytes](const auto& numbers_of) {
    bytes.append(reinterpret_cast<const char*>(numbers_of.data()),
                 numbers_of.size() * sizeof(numbers_of[0]));
  };
  append(head);
  append(times);
  append(numbers);
  return bytes;
}

// Provides the table of the run, its signals or its motion, but no other file of its folder.
std::optional<Download> ReplaySource::download(std::string_view name) {
  if (name == "history.bin") return Download{"history.bin", "application/octet-stream", history()};
  if (name == "motion.glb") return Download{"motion.glb", "model/gltf-binary", motion()};
  if (name != "run.csv") return std::nullopt;
  std::ifstream file(folder_ / "run.csv", std::ios::binary);
  if (!file) return std::nullopt;
  return Download{"run.csv",
                  "text/csv; charset=utf-8",
                  {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}};
}

}  // namespace sinew::viewer
