#include "gallery_source.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include <nlohmann/json.hpp>

#include "live_source.hpp"

namespace sinew::viewer {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// The title of a scene: the first sentence of its first comment ("# A soft trunk ..."), which may
// extend over several lines.
std::string first_sentence(const fs::path& path) {
  std::ifstream file(path);
  std::string text;
  for (std::string line; std::getline(file, line) && line.starts_with("#");) {
    const std::size_t begin = line.find_first_not_of("# ");
    if (begin == std::string::npos) break;
    text += (text.empty() ? "" : " ") + line.substr(begin);
  }
  return text.substr(0, text.find(". ") == std::string::npos ? text.size() : text.find(". ") + 1);
}

std::string read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::unique_ptr<Source> open_example(const fs::path& path, const std::vector<Example>& examples) {
  scene::Robot robot = scene::load(path);
  LiveSettings settings;
  settings.gallery = [examples] { return std::make_unique<GallerySource>(examples); };
  if (const auto* first = robot.first_controller()) settings.controller = first->name;
  auto source = std::make_unique<LiveSource>(std::move(robot), settings);
  source->await_page();
  return source;
}

}  // namespace

std::vector<Example> find_examples(const fs::path& folder) {
  std::vector<Example> result;
  std::error_code problem;
  for (const auto& entry : fs::recursive_directory_iterator(folder, problem)) {
    if (entry.path().extension() != ".yaml" || !entry.is_regular_file()) continue;
    Example example;
    example.scene = entry.path();
    example.thumbnail = fs::path(entry.path()).replace_extension(".png");
    example.name = fs::relative(entry.path(), folder).replace_extension().generic_string();
    example.title = first_sentence(entry.path());
    result.push_back(std::move(example));
  }
  std::ranges::sort(result, {}, &Example::name);
  return result;
}

GallerySource::GallerySource(std::vector<Example> examples) : examples_(std::move(examples)) {
  if (examples_.empty()) {
    throw Error(ErrorKind::empty_list, {.item = "SCENE"}, "there are no examples to show",
                "name a scene: sinew view SCENE");
  }
  Json list = Json::array();
  for (const Example& example : examples_) {
    std::error_code problem;
    const bool seen = fs::exists(example.thumbnail, problem);
    list.push_back({{"name", example.name},
                    {"title", example.title},
                    {"thumbnail",
                     seen ? Json("/download/thumbnail/" + example.name + ".png") : Json(nullptr)}});
  }
  const Json empty = Json::array();
  description_.scene = Json{{"name", "Examples"},   {"time_step", 0.01},
                            {"gravity", {0, 0, 0}}, {"bounds", {{0, 0, 0}, {1, 1, 1}}},
                            {"bodies", empty},      {"fields", empty},
                            {"actuators", empty},   {"effectors", empty},
                            {"probes", empty},      {"contacts", empty},
                            {"joints", empty},      {"controllers", empty},
                            {"signals", empty},     {"examples", list}}
                           .dump();
}

void GallerySource::start(Publisher& publisher) {
  publisher_ = &publisher;
  publisher.publish_status(
      R"({"playing":false,"speed":1,"slow":false,"controller":null,"commands":{},"targets":{},)"
      R"("troubles":[],"stopped":null})");
}

const Example& GallerySource::find(const std::string& name) const {
  const auto found = std::ranges::find(examples_, name, &Example::name);
  if (found != examples_.end()) return *found;
  std::vector<std::string> names;
  for (const Example& example : examples_) names.push_back(example.name);
  const std::string nearest = nearest_word(name, names);
  throw Error(ErrorKind::unknown_name, {.item = "name"}, "there is no example '" + name + "'",
              nearest.empty() ? "choose one of the gallery" : "did you mean '" + nearest + "'?");
}

void GallerySource::submit(const Request& request, std::function<void(Outcome)> done) {
  try {
    if (const auto* open = std::get_if<Open>(&request)) {
      const fs::path path = find(open->name).scene;
      publisher_->replace([path, examples = examples_] { return open_example(path, examples); });
    } else if (!std::holds_alternative<Release>(request) &&
               !std::holds_alternative<ChooseField>(request) &&
               !std::holds_alternative<Pick>(request) &&
               !std::holds_alternative<ShowInside>(request) &&
               !std::holds_alternative<Ready>(request)) {
      throw Error(ErrorKind::not_in_this_version, {}, "the gallery cannot do this",
                  "open an example first");
    }
  } catch (const Error& error) {
    return done(error);
  }
  done({});
}

void GallerySource::fetch(std::string_view name,
                          std::function<void(std::optional<Download>)> done) {
  for (const Example& example : examples_) {
    if (name != "thumbnail/" + example.name + ".png") continue;
    return done(Download{"thumbnail.png", "image/png", read_all(example.thumbnail)});
  }
  done(std::nullopt);
}

}  // namespace sinew::viewer
