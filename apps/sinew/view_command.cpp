// sinew view: shows a scene in the browser.
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

#include "arguments.hpp"
#include "commands.hpp"
#include "session.hpp"
#include "terminal.hpp"

#ifdef SINEW_HAS_VIEWER
#include "viewer/browser.hpp"
#include "viewer/gallery_source.hpp"
#include "viewer/limits.hpp"
#include "viewer/live_source.hpp"
#include "viewer/replay_source.hpp"
#include "viewer/server.hpp"
#endif

namespace sinew::cli {

namespace {

constexpr int kLastPort = 65535;

struct ViewOptions {
  SceneOptions scene;
  std::string host = "127.0.0.1";
  std::optional<int> port;
  bool no_open = false;
  bool paused = false;
  double speed = 1.0;
};

#ifdef SINEW_HAS_VIEWER

// The folder in the source tree, or the installed one.
std::filesystem::path examples_folder() {
  std::error_code problem;
  std::filesystem::path built = SINEW_EXAMPLES_DEFAULT;
  if (std::filesystem::exists(built, problem)) return built;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", problem);
  return self.parent_path().parent_path() / "share/sinew/examples";
}

/// The source to be shown: a scene, a recorded run, or the gallery.
std::unique_ptr<viewer::Source> source_of(const ViewOptions& options) {
  if (options.scene.file.empty()) {
    return std::make_unique<viewer::GallerySource>(viewer::find_examples(examples_folder()));
  }
  if (viewer::is_recorded_run(options.scene.file)) {
    auto replay =
        std::make_unique<viewer::ReplaySource>(options.scene.file, !options.paused, options.speed);
    if (!replay->lacks().empty()) {
      fmt::print(stderr, "sinew: remark: {}: this run was {}\n", options.scene.file.string(),
                 replay->lacks());
    }
    replay->await_page();
    return replay;
  }
  const LoadedScene scene = load_scene(options.scene);
  auto live = std::make_unique<viewer::LiveSource>(
      scene.robot, viewer::LiveSettings{scene.controller, !options.paused, options.speed, {}});
  live->await_page();
  return live;
}

int view(const ViewOptions& options) {
  if (options.port) require_range("--port", *options.port, 0, kLastPort);
  if (!viewer::limits::is_speed(options.speed)) {
    throw Error(ErrorKind::out_of_range, {.item = "--speed"},
                fmt::format("{:g} is out of range", options.speed),
                "give 0.01 to 100 simulated seconds per second, or 0 for as fast as possible");
  }
  viewer::ServerSettings settings{options.host, std::nullopt};
  if (options.port) settings.port = static_cast<std::uint16_t>(*options.port);
  viewer::Server server(settings, source_of(options));
  const Interrupt interrupt;
  server.start();
  fmt::print("the view is at {}\npress Ctrl-C to quit\n", server.url());
  std::fflush(stdout);
  if (!options.no_open) viewer::open_browser(server.url());
  while (!Interrupt::requested()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.stop();
  return 0;
}

#else

int view(const ViewOptions&) {
  throw Error(ErrorKind::tool_missing, {.item = "view"}, "this build has no view",
              "configure the build with -D SINEW_VIEWER=ON");
}

#endif

}  // namespace

void add_view(CommandLine& line) {
  Command command = line.add_command(
      "view", "Run a scene interactively in the browser, or replay a recorded run");
  const auto options = std::make_shared<ViewOptions>();
  add_scene_options(command, options->scene, true);
  command
      .add_option("--port", options->port,
                  "Port to listen on; 0 for any free port (default: 8080 or the next free one)")
      .type_name("N");
  command
      .add_option("--host", options->host,
                  "Address to listen on; any other than the default requires the token in the "
                  "printed URL (default: 127.0.0.1, this machine only)")
      .type_name("ADDRESS");
  command
      .add_option("--speed", options->speed,
                  "Simulated seconds per second; 0 for as fast as possible (default: 1)")
      .type_name("X");
  command.add_flag("--paused", options->paused, "Start paused");
  command.add_flag("--no-open", options->no_open, "Do not open a browser");
  command.footer(
      "SCENE may also be the output folder of a run. Without SCENE, a gallery of the examples "
      "opens.\n\n"
      "Examples:\n"
      "  sinew view\n"
      "  sinew view examples/trunk/circle.yaml\n"
      "  sinew view trunk.yaml --controller none --paused\n"
      "  sinew view out/circle");
  command.set_action([options] { return view(*options); });
}

}  // namespace sinew::cli
