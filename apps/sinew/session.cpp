#include "session.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/model/model.hpp"
#include "sinew/scene/scene.hpp"
#include "sinew/sim/simulation.hpp"

#include "arguments.hpp"
#include "command_line.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

constexpr int kMaxThreads = 256;
constexpr double kSlowStep = 2.0;         // s, of wall time
constexpr std::size_t kManyPoints = 500;  // of contacts, which then dominate the time of a step

scene::Robot load(const SceneOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (options.threads) {
    require_range("--threads", *options.threads, 1, kMaxThreads);
    overrides.push_back(fmt::format("solver.threads={}", *options.threads));
  }
  scene::Robot robot = scene::load(options.file, overrides);
  print_warnings(robot.notices);
  return robot;
}

// Advice if the contacts have many points; else empty.
std::string contact_hint(const model::Model& model) {
  std::size_t points = 0, single = 0;
  for (std::size_t i = 0; i < model.contacts().size(); ++i) {
    const std::size_t size = model.contact(static_cast<int>(i)).size();
    points += size;
    if (!(model.contacts()[i].aggregate > 0.0)) single += size;
  }
  if (points < kManyPoints) return {};
  return fmt::format("; the contacts have {} points: use fewer, or {}", points,
                     single < kManyPoints ? "a larger `aggregate`" : "`aggregate`");
}

// The controller to attach: none, the named one, or the first.
const scene::SceneController* choose(const scene::Robot& robot, const std::string& name) {
  if (name == "none") return nullptr;
  if (name.empty()) return robot.first_controller();
  return &robot.controller(name, {.item = "--controller"});
}

}  // namespace

LoadedScene load_scene(const SceneOptions& options) {
  LoadedScene result{load(options), {}};
  if (const auto* chosen = choose(result.robot, options.controller)) {
    result.controller = chosen->name;
  }
  return result;
}

Session::Session(const SceneOptions& options)
    : robot_(load(options)), folder_(std::filesystem::absolute(options.file).parent_path()) {
  const scene::SceneController* chosen = choose(robot_, options.controller);
  simulation_ = std::make_unique<sim::Simulation>(robot_.model, robot_.threads());
  if (chosen == nullptr) return;
  controller_name_ = chosen->name;
  controller_ = control::make_controller(*simulation_, chosen->settings);
}

double Session::first_turn() const {
  double end = 0.0;
  if (!controller_) return end;
  for (const control::EffectorTask& task : controller_->settings().tasks) {
    end = std::max(end, task.target.end_time());
  }
  return end;
}

std::string Session::resolved_scene() const {
  scene::Node tree = robot_.description.tree;
  scene::resolve_paths(tree, folder_);
  return scene::to_yaml(tree);
}

sim::Watched watch_steps(sim::Simulation& simulation, ProgressBar& bar, const std::int64_t& done) {
  return {simulation, [&simulation, &bar, &done](const run::StepProgress& step) {
            Interrupt::check();
            if (step.seconds < kSlowStep || !bar.slow_due()) return;
            bar.update_slow(done,
                            fmt::format("t = {:g} s: this step has taken {:.0f} s: iteration {}, "
                                        "residual {:.1e}, {}{}",
                                        simulation.time(), step.seconds, step.iterations,
                                        step.relative_residual, search_stage_text(step.stage),
                                        contact_hint(simulation.model())));
          }};
}

void add_scene_options(Command& command, SceneOptions& options, bool optional) {
  command.add_option("SCENE", options.file, "Scene file (YAML)").required(!optional);
  command
      .add_option("--set", options.overrides,
                  "Override a scene value, e.g. actuators.long_0.command.displacement=10mm "
                  "(repeatable)")
      .type_name("PATH=VALUE")
      .allow_extra_args(false);
  command
      .add_option("--threads", options.threads,
                  "Threads per step (default: the scene's solver.threads, else 1)")
      .type_name("N");
  command
      .add_option("--controller", options.controller,
                  "Controller of the scene to use, or 'none' (default: the first)")
      .type_name("NAME");
}

}  // namespace sinew::cli
