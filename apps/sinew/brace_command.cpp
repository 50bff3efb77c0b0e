// sinew brace: finds where an arm can lean on an object, and how much steadier its tip then is.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/plan/brace_run.hpp"

#include "arguments.hpp"
#include "arm_limits.hpp"
#include "arm_scene.hpp"
#include "brace_report.hpp"
#include "commands.hpp"
#include "python_tool.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

using plan::Brace;
using plan::BraceRun;
using plan::BraceTask;

constexpr int kMaxSeeds = 1000;

struct BraceOptions {
  ArmSceneOptions scene;
  std::string goal;
  std::optional<std::string> friction, tolerance, hold_force, hold_frequency, disturbance, hold;
  int segments = 0;
  int starts = BraceTask{}.starts;
  int seeds = 1;
  std::uint64_t seed = 1;
  std::optional<std::string> json;
  std::string out, plot;
};

/// Parses friction: the name of a pair of surfaces, one coefficient, or two.
plan::FrictionRange friction_of(const std::string& text) {
  if (text.find_first_of("0123456789") == std::string::npos) return plan::friction_range(text);
  const std::vector<double> values = parse_list(text, dimension::kNone, -1, {.item = "--friction"});
  if (values.size() <= 2) return {"given", values.front(), values.back()};
  throw Error(ErrorKind::wrong_length, {.item = "--friction"},
              fmt::format("'{}' has {} numbers", text, values.size()),
              "write 0.6, \"0.6 0.9\", silicone-on-steel or coated-rigid");
}

/// The surfaces of the scene's contacts with the arm, and their names.
std::vector<std::string> take_objects(const BraceOptions& options, const ArmScene& scene,
                                      BraceTask& task) {
  std::vector<std::string> names;
  for (const auto& contact : scene.description.contacts) {
    if (contact.body != scene.arm->settings().name || !contact.other.empty()) continue;
    if (contact.motion) {
      throw Error(ErrorKind::bad_argument,
                  {.file = options.scene.file.string(),
                   .item = fmt::format("contacts.{}.motion", contact.name)},
                  "the arm cannot brace on a moving surface", "remove the motion of this contact");
    }
    plan::BraceObject object;
    object.surface = contact.surface;
    object.friction = options.friction
                          ? friction_of(*options.friction)
                          : plan::FrictionRange{"scene's", contact.friction, contact.friction};
    task.objects.push_back(object);
    names.push_back(contact.name);
  }
  return names;
}

BraceTask task_of(const BraceOptions& options, const ArmScene& scene,
                  std::vector<std::string>& names) {
  BraceTask task;
  task.goal = parse_vector3(options.goal, dimension::kLength, {.item = "--goal"});
  if (options.tolerance) {
    task.tolerance = positive_quantity("--tolerance", *options.tolerance, dimension::kLength);
  }
  if (options.hold_force) {
    task.hold_force = positive_quantity("--hold-force", *options.hold_force, dimension::kForce);
  }
  if (options.hold_frequency) {
    task.hold_frequency =
        positive_quantity("--hold-frequency", *options.hold_frequency, dimension::kFrequency);
  }
  task.limits = limits_of(scene);
  task.starts = options.starts;
  names = take_objects(options, scene, task);
  return plan::completed(*scene.arm, std::move(task));
}

plan::BraceRunSettings run_settings(const BraceOptions& options) {
  plan::BraceRunSettings settings;
  if (options.disturbance) {
    settings.disturbance.force =
        positive_quantity("--disturbance", *options.disturbance, dimension::kForce);
  }
  if (options.hold) {
    settings.hold = positive_quantity("--duration", *options.hold, dimension::kTime);
  }
  return settings;
}

Brace search(const BraceOptions& options, const ArmScene& scene, const BraceTask& task) {
  const int first = options.segments > 0 ? options.segments : 1;
  const int last = options.segments > 0 ? options.segments : scene.arm->segments();
  ProgressBar bar(last - first + 1, true);
  const Interrupt interrupt;
  Brace brace;
  for (int n = first; n <= last && !brace.found() && !Interrupt::requested(); ++n) {
    bar.update(n - first, fmt::format("segment {} of {}", n, last));
    Brace found = plan::find_brace(scene.arm, task, n);
    if (n == first || found.found() || found.object >= 0 || brace.object < 0) {
      brace = std::move(found);
    }
  }
  return brace;
}

std::vector<BraceTrial> carry_out(const BraceOptions& options, const ArmScene& scene,
                                  const BraceTask& task, const Brace& brace) {
  plan::BraceRunSettings settings = run_settings(options);
  std::vector<BraceTrial> trials;
  ProgressBar bar(options.seeds, true);
  const Interrupt interrupt;
  for (int k = 0; k < options.seeds && !Interrupt::requested(); ++k) {
    bar.update(k, fmt::format("disturbance {} of {}", k + 1, options.seeds));
    BraceTrial trial{options.seed + static_cast<std::uint64_t>(k), {}, {}};
    settings.disturbance.seed = trial.seed;
    trial.braced = plan::run_brace(scene.arm, task, brace, settings);
    trial.bare = plan::run_free(scene.arm, task, settings);
    trials.push_back(std::move(trial));
  }
  return trials;
}

void print_conditions(const Brace& brace) {
  if (brace.object < 0) return;
  std::vector<std::vector<std::string>> rows = {{"condition", "verdict", "value", "limit"}};
  for (const plan::BraceCondition& condition : brace.conditions) {
    rows.push_back({std::string(condition.name), std::string(plan::verdict_name(condition.verdict)),
                    fmt::format("{:.3g}", condition.value),
                    fmt::format("{:.3g}", condition.limit)});
  }
  fmt::print("{}", format_table(rows));
}

void print_brace(const Brace& brace, const BraceTask& task, const std::vector<std::string>& names) {
  fmt::print("{}", plan::status_name(brace.status));
  if (brace.found()) {
    const Vector3 place = 100.0 * brace.place;
    fmt::print(
        ": segment {} at {:g} of its length leans on '{}' at {:.2f} {:.2f} {:.2f} cm\n"
        "force {:.3f} N, friction {:.3f} N; sticks under up to {:.3f} N on the tip up to {:g} Hz\n"
        "compliance of the tip {:.4f} m/N at rest, at most {:.4f} m/N up to this frequency",
        brace.segments, brace.point.fraction, names[static_cast<std::size_t>(brace.object)],
        place[0], place[1], place[2], brace.normal_force, brace.friction_force, brace.hold_force,
        task.hold_frequency, brace.tip_compliance, brace.peak_compliance);
  }
  fmt::print("\n");
  print_conditions(brace);
}

void print_trials(const std::vector<BraceTrial>& trials) {
  std::vector<std::vector<std::string>> rows = {{"disturbance", "status", "slipped ms", "spread mm",
                                                 "error mm", "spread, not braced",
                                                 "error, not braced"}};
  for (const BraceTrial& trial : trials) {
    const double step = trial.braced.times.size() > 1 ? trial.braced.times[1] : 0.0;
    rows.push_back({fmt::format("{}", trial.seed),
                    std::string(plan::status_name(trial.braced.status)),
                    fmt::format("{:.0f}", 1e3 * step * trial.braced.slips)});
    for (const BraceRun* run : {&trial.braced, &trial.bare}) {
      rows.back().push_back(fmt::format("{:.2f}", 1e3 * run->spread));
      rows.back().push_back(fmt::format("{:.2f}", 1e3 * run->mean_error));
    }
  }
  fmt::print(
      "{}spread: RMS distance of the disturbed tip from its mean; error: its mean distance from "
      "the goal\n",
      format_table(rows));
}

[[noreturn]] void give_up(const Brace& brace, const BraceTask& task, const ArmScene& scene) {
  const std::string& arm = scene.arm->settings().name;
  if (task.objects.empty()) {
    throw Error(
        ErrorKind::not_converged, {.item = "brace"},
        fmt::format("infeasible: the scene has no contact of '{}' to lean on", arm),
        fmt::format("add one: contacts: {{wall: {{body: {}, surface: {{plane: {{point: -4 0 "
                    "0 cm, normal: 1 0 0}}}}, points: [-25 0 -280 mm], friction: 0.6}}}}",
                    arm));
  }
  throw Error(ErrorKind::not_converged, {.item = "brace"},
              fmt::format("no brace found: {}", plan::status_name(brace.status)),
              brace.status == plan::BraceStatus::no_object_in_reach
                  ? "move an object within reach of the arm"
                  : "move the object or the goal, reduce --hold-force, increase --tolerance "
                    "or --starts, or raise the torque limits");
}

int find_and_carry_out(const BraceOptions& options) {
  require_range("--disturbances", options.seeds, 1, kMaxSeeds);
  require_range("--starts", options.starts, 1, kMaxSeeds);
  const ArmScene scene = load_arm_scene(options.scene);
  require_inputs(scene);
  require_range("--segment", options.segments, 0, scene.arm->segments());
  std::vector<std::string> names;
  const BraceTask task = task_of(options, scene, names);
  static_cast<void>(run_settings(options));  // reports errors before the search
  print_left_out(scene);
  const Brace brace = search(options, scene, task);
  print_brace(brace, task, names);
  std::vector<BraceTrial> trials;
  if (brace.found()) trials = carry_out(options, scene, task, brace);
  const nlohmann::ordered_json json = brace_json(scene, task, names, brace, trials);
  if (options.json) write_file(*options.json, json.dump(2) + "\n");
  if (!brace.found()) give_up(brace, task, scene);
  if (trials.empty()) return 0;  // interrupted
  print_trials(trials);
  const BraceRun& run = trials.front().braced;
  if (!options.out.empty()) {
    write_file(options.out, brace_table(scene, run));
    fmt::print("wrote {}\n", options.out);
  }
  if (run.status != plan::BraceRunStatus::held && run.status != plan::BraceRunStatus::slipped) {
    throw Error(
        ErrorKind::not_converged, {.item = "brace"},
        fmt::format("the brace was not reached in simulation: {}", plan::status_name(run.status)),
        "reduce --hold-force, increase --tolerance, or move the object");
  }
  return options.plot.empty() ? 0 : draw_json("brace", json.dump(), options.plot);
}

}  // namespace

void add_brace(CommandLine& line) {
  Command command =
      line.add_command("brace", "Find where an arm can lean on its environment to steady its tip");
  const auto options = std::make_shared<BraceOptions>();
  options->scene.takes_contacts = true;  // contacts are its objects
  add_arm_scene_options(command, options->scene);
  command.add_option("--goal", options->goal, "Goal of the tip, e.g. \"5 0 -53 cm\"")
      .required()
      .type_name("POINT");
  command
      .add_option("--friction", options->friction,
                  "Friction coefficient of all objects: 0.6, a range \"0.6 0.9\", "
                  "silicone-on-steel or coated-rigid (default: the scene's)")
      .type_name("MU");
  command
      .add_option("--tolerance", options->tolerance,
                  "Distance of the tip from the goal (default: 5mm)")
      .type_name("LENGTH");
  command
      .add_option("--hold-force", options->hold_force,
                  "Tip force under which the braced point must not slip (default: 0.04N)")
      .type_name("FORCE");
  command
      .add_option("--hold-frequency", options->hold_frequency,
                  "Highest frequency of that force (default: 2Hz)")
      .type_name("FREQUENCY");
  command
      .add_option("--segment", options->segments,
                  "Segment to brace, counted from 1 (default: the first that can brace)")
      .type_name("N");
  command.add_option("--starts", options->starts, "Starts of the search per candidate (default: 2)")
      .type_name("N");
  command
      .add_option("--disturbance", options->disturbance,
                  "Random force on the tip, RMS per axis (default: 0.01N)")
      .type_name("FORCE");
  command.add_option("--duration", options->hold, "Duration of the disturbance (default: 4s)")
      .type_name("TIME");
  command
      .add_option("--disturbances", options->seeds,
                  "Number of disturbances to simulate (default: 1)")
      .type_name("N");
  command.add_option("--seed", options->seed, "Random seed of the first disturbance (default: 1)")
      .type_name("S");
  command.add_option("--json", options->json, "Also write the results as JSON").type_name("FILE");
  command.add_option("-o,--out", options->out, "Write the first run as CSV").type_name("FILE");
  command.add_option("--plot", options->plot, "Plot poses, forces and tip error to a PNG file")
      .type_name("FILE");
  command.footer(
      "The objects are the surfaces of the scene's contacts with the arm.\n\n"
      "Example:\n"
      "  sinew brace examples/fluidic_arm/brace.yaml --goal \"5 0 -53 cm\" --disturbances 5 --plot "
      "brace.png");
  command.set_action([options] { return find_and_carry_out(*options); });
}

}  // namespace sinew::cli
