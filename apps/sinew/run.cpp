#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "sinew/core/quantity.hpp"
#include "sinew/record/run_recorder.hpp"
#include "sinew/scene/build.hpp"
#include "sinew/scene/scene.hpp"

#include "commands.hpp"
#include "progress.hpp"

namespace sinew::cli {

namespace {

volatile std::sig_atomic_t interrupted = 0;
void interrupt(int) { interrupted = 1; }

// What to tell at the end of a run.
struct Summary {
  long steps = 0;
  double wall = 0.0, simulated = 0.0;
  double worst_residual = 0.0;
  int cut_back = 0;
  std::array<long, 4> statuses{};
  double error_sum = 0.0, error_max = 0.0;
  long error_count = 0;
};

double duration_of(const scene::Robot& robot, const std::string& asked) {
  if (!asked.empty()) {
    return parse_quantity(asked, dimension::kTime, {.file = {}, .item = "--duration"});
  }
  const double duration = robot.description.run_duration();
  if (!(duration > 0.0)) {
    throw Error(ErrorKind::missing_key, {.file = robot.description.place.file, .item = "duration"},
                "the scene does not say how long to run, and no signal ends",
                "add `duration: 5 s` to the scene, or run with --duration 5s");
  }
  return duration;
}

std::unique_ptr<inverse::InverseController> attach(const scene::Robot& robot,
                                                   sim::Simulation& simulation,
                                                   const std::string& name) {
  if (robot.controllers.empty() || name == "none") return nullptr;
  if (name.empty()) {
    return std::make_unique<inverse::InverseController>(simulation, robot.controllers[0].settings);
  }
  std::vector<std::string> names;
  for (const auto& controller : robot.controllers) {
    if (controller.name == name) {
      return std::make_unique<inverse::InverseController>(simulation, controller.settings);
    }
    names.push_back(controller.name);
  }
  throw Error(ErrorKind::unknown_name, {.file = {}, .item = "--controller"},
              fmt::format("the scene has no controller '{}'", name),
              fmt::format("there are: {}, none", fmt::join(names, ", ")));
}

void count(Summary& summary, const sim::Simulation& simulation,
           const inverse::InverseController* controller, double settle_time) {
  const auto& report = simulation.report();
  summary.cut_back += report.scale < 1.0 ? 1 : 0;
  if (controller == nullptr) return;
  ++summary.statuses[static_cast<std::size_t>(controller->status())];
  if (simulation.time() < settle_time) return;
  summary.worst_residual = std::max(summary.worst_residual, report.relative_residual);
  summary.error_sum += controller->error();
  summary.error_max = std::max(summary.error_max, controller->error());
  ++summary.error_count;
}

void print(const Summary& summary, const scene::Robot& robot, const sim::Simulation& simulation,
           const inverse::InverseController* controller, const std::filesystem::path& folder) {
  fmt::print("{:<22}{} ({:g} s simulated)\n", "steps", summary.steps, summary.simulated);
  fmt::print("{:<22}{:.3f} s, {:.1f} times real time\n", "wall time", summary.wall,
             summary.simulated / std::max(summary.wall, 1e-9));
  if (summary.cut_back > 0) fmt::print("{:<22}{} steps\n", "cut back", summary.cut_back);
  for (std::size_t i = 0; i < robot.model->effectors().size(); ++i) {
    const Vector3 at = simulation.effector_value(static_cast<int>(i));
    const bool turn = std::string(robot.model->effector(static_cast<int>(i)).unit()) == "rad";
    const double scale = turn ? 1.0 : 1e3;
    fmt::print("{:<22}({:.3f}, {:.3f}, {:.3f}) {}\n", robot.model->effectors()[i].name,
               scale * at.x(), scale * at.y(), scale * at.z(), turn ? "rad" : "mm");
  }
  if (controller != nullptr) {
    std::string statuses;
    for (std::size_t k = 0; k < summary.statuses.size(); ++k) {
      if (summary.statuses[k] == 0) continue;
      statuses += fmt::format("{}{} {}", statuses.empty() ? "" : ", ",
                              inverse_status_name(static_cast<inverse::InverseStatus>(k)),
                              summary.statuses[k]);
    }
    fmt::print("{:<22}{}\n", "status (steps)", statuses);
    if (summary.error_count > 0) {
      fmt::print("{:<22}mean {:.4f} mm, largest {:.4f} mm, second half\n", "distance to target",
                 1e3 * summary.error_sum / static_cast<double>(summary.error_count),
                 1e3 * summary.error_max);
    }
  }
  fmt::print("{:<22}{}\n", "written to", folder.string());
}

}  // namespace

int run(const RunOptions& options) {
  const scene::Robot robot = scene::load(options.scene, options.overrides);
  const double duration = duration_of(robot, options.duration);
  sim::Simulation simulation(robot.model, options.threads > 0 ? options.threads : robot.threads());
  const auto controller = attach(robot, simulation, options.controller);
  record::RecordSettings settings;
  settings.folder = options.out.empty() ? std::filesystem::path("out") / robot.description.name
                                        : std::filesystem::path(options.out);
  settings.every = robot.description.record.every;
  settings.states = robot.description.record.states;
  settings.vtk = options.vtk;
  scene::Node tree = robot.description.tree;
  scene::resolve_paths(tree, std::filesystem::absolute(options.scene).parent_path());
  settings.scene = scene::to_yaml(tree);
  record::RunRecorder recorder(simulation, controller.get(), settings);

  const auto steps = std::lround(std::ceil(duration / robot.model->step().time_step - 1e-9));
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  Progress progress(steps, !options.quiet);
  Summary summary;
  const auto begin = std::chrono::steady_clock::now();
  const auto finish = [&] {
    summary.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    summary.simulated = simulation.time();
    recorder.finish();
    progress.clear();
    if (!options.quiet) print(summary, robot, simulation, controller.get(), settings.folder);
  };
  recorder.record();
  try {
    while (summary.steps < steps && interrupted == 0) {
      simulation.step();
      recorder.record();
      ++summary.steps;
      count(summary, simulation, controller.get(), 0.5 * duration);
      progress.show(summary.steps, fmt::format("t = {:.2f} s", simulation.time()));
    }
  } catch (const Error&) {
    finish();
    throw;
  }
  finish();
  if (interrupted != 0) fmt::print("interrupted; what was recorded so far is complete\n");
  return 0;
}

}  // namespace sinew::cli
