// sinew view: a scene in the browser.
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include "sinew/core/error.hpp"

#include "arguments.hpp"
#include "commands.hpp"
#include "session.hpp"
#include "terminal.hpp"

#ifdef SINEW_HAS_VIEWER
#include "viewer/live_source.hpp"
#include "viewer/server.hpp"
#endif

namespace sinew::cli {

namespace {

constexpr int kDefaultPort = 8080;
constexpr int kLastPort = 65535;
constexpr int kPortsToTry = 20;

struct ViewOptions {
  SceneOptions scene;
  std::string host = "127.0.0.1";
  std::optional<int> port;
  bool no_open = false;
  bool paused = false;
  double speed = 1.0;
};

#ifdef SINEW_HAS_VIEWER

// Where there is a screen; a browser that does not start is no error.
void open_browser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "xdg-open", address = url;
  char* const words[] = {program.data(), address.data(), nullptr};
  pid_t child = 0;
  static_cast<void>(posix_spawnp(&child, program.c_str(), nullptr, nullptr, words, environ));
}

// The port that was asked for; else the first free one from the usual one on.
std::unique_ptr<viewer::Server> serve(const ViewOptions& options, const LoadedScene& scene) {
  viewer::LiveSettings live;
  live.controller = scene.controller;
  live.playing = !options.paused;
  live.speed = options.speed;
  for (int k = 0;; ++k) {
    const int port = options.port.value_or(kDefaultPort + k);
    try {
      return std::make_unique<viewer::Server>(
          viewer::ServerSettings{options.host, static_cast<std::uint16_t>(port)},
          std::make_unique<viewer::LiveSource>(scene.robot, live));
    } catch (const Error& error) {
      const bool again = error.kind() == ErrorKind::address_in_use && !options.port;
      if (!again || k == kPortsToTry) throw;
    }
  }
}

int view(const ViewOptions& options) {
  if (options.port) require_range("--port", *options.port, 0, kLastPort);
  if (options.speed != 0.0 && !(options.speed >= 0.01 && options.speed <= 100.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "--speed"},
                fmt::format("{:g} is out of range", options.speed),
                "give 0.01 to 100 simulated seconds a second, or 0 for as fast as it can");
  }
  const LoadedScene scene = load_scene(options.scene);
  const std::unique_ptr<viewer::Server> server = serve(options, scene);
  const Interrupt interrupt;
  server->start();
  fmt::print("{} at {}\nCtrl-C ends it\n", scene.robot.description.name, server->url());
  std::fflush(stdout);
  if (!options.no_open) open_browser(server->url());
  while (!Interrupt::requested()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server->stop();
  return 0;
}

#else

int view(const ViewOptions&) {
  throw Error(ErrorKind::tool_missing, {.item = "view"}, "this program was built without the view",
              "build it with -DSINEW_VIEWER=ON");
}

#endif

}  // namespace

void add_view(CLI::App& app, Actions& actions) {
  CLI::App* command = app.add_subcommand("view", "See a scene run in the browser, and drive it");
  const auto options = std::make_shared<ViewOptions>();
  add_scene_options(*command, options->scene);
  command
      ->add_option("--port", options->port,
                   "Port to listen on; 0: any that is free (default: 8080 or the next free one)")
      ->type_name("N");
  command
      ->add_option(
          "--host", options->host,
          "Address to listen on (default: 127.0.0.1, this machine alone). Another one asks "
          "browsers for the token in the printed URL")
      ->type_name("ADDRESS");
  command
      ->add_option("--speed", options->speed,
                   "Simulated seconds a second; 0: as fast as it can (default: 1)")
      ->type_name("X");
  command->add_flag("--paused", options->paused, "Start paused");
  command->add_flag("--no-open", options->no_open, "Do not open a browser");
  command->footer(
      "Examples:\n"
      "  sinew view examples/trunk/circle.yaml\n"
      "  sinew view trunk.yaml --controller none --paused");
  actions[command] = [options] { return view(*options); };
}

}  // namespace sinew::cli
