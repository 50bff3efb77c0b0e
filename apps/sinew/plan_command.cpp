// sinew plan: finds torques that swing an arm's tip to a goal.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/csv.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/file.hpp"
#include "sinew/plan/replay.hpp"

#include "arguments.hpp"
#include "arm_limits.hpp"
#include "arm_scene.hpp"
#include "commands.hpp"
#include "python_tool.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

using plan::CollocationMethod;
using plan::Plan;
using plan::PlanTask;
using plan::Replay;

constexpr int kMaxSeeds = 1000;
constexpr int kMaxIntervals = 10000;
// Range of a free duration, relative to the requested one.
constexpr double kMinShare = 0.5, kMaxShare = 2.0;
// Time over which a table has a jump of torque, as a fraction of an interval, since times must
// increase.
constexpr double kJump = 1e-6;

struct PlanOptions {
  ArmSceneOptions scene;
  std::string goal;
  std::optional<std::string> duration, rate_limit, tolerance, speed_tolerance;
  bool free_duration = false;
  std::string method = "radau";
  int intervals = plan::Grid{}.intervals;
  int seeds = 1;
  std::uint64_t seed = 1;
  std::optional<std::string> json;
  std::string out, plot;
};

/// The result of one random start.
struct Attempt {
  std::uint64_t seed = 0;
  Plan plan;
};

CollocationMethod method_of(const std::string& name) {
  for (const CollocationMethod method :
       {CollocationMethod::radau, CollocationMethod::backward_euler}) {
    if (name == plan::method_name(method)) return method;
  }
  throw Error(ErrorKind::unknown_choice, {.item = "--method"},
              fmt::format("there is no method '{}'", name), "write radau or backward-euler");
}

// Torque has the dimension of energy, so errors would call its rate a power.
double torque_rate(const std::string& text) {
  try {
    return positive_quantity("--rate-limit", text, dimension::kPower);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::wrong_dimension) throw;
    throw Error(error.kind(), error.place(), fmt::format("'{}' is not a torque rate", text),
                "write for example 2Nm/s");
  }
}

PlanTask task_of(const PlanOptions& options, const ArmScene& scene) {
  PlanTask task;
  task.goal.position = parse_vector3(options.goal, dimension::kLength, {.item = "--goal"});
  if (options.tolerance) {
    task.goal.tolerance = positive_quantity("--tolerance", *options.tolerance, dimension::kLength);
  }
  if (options.speed_tolerance) {
    task.goal.speed_tolerance =
        positive_quantity("--speed-tolerance", *options.speed_tolerance, dimension::kVelocity);
  }
  task.limits = limits_of(scene);
  if (options.rate_limit) {
    task.limits.torque_rate = task.limits.torque_rate.cwiseMin(torque_rate(*options.rate_limit));
  }
  task.grid.method = method_of(options.method);
  require_range("--intervals", options.intervals, 2, kMaxIntervals);
  task.grid.intervals = options.intervals;
  if (options.duration) {
    task.grid.duration = positive_quantity("--duration", *options.duration, dimension::kTime);
  }
  if (options.free_duration) {
    task.grid.min_duration = kMinShare * task.grid.duration;
    task.grid.max_duration = kMaxShare * task.grid.duration;
  }
  return plan::completed(*scene.arm, std::move(task));
}

std::vector<Attempt> search(const PlanOptions& options, const ArmScene& scene,
                            const PlanTask& task) {
  plan::Planner planner(scene.arm, task);
  std::vector<Attempt> attempts;
  ProgressBar bar(options.seeds, true);
  const Interrupt interrupt;
  for (int k = 0; k < options.seeds && !Interrupt::requested(); ++k) {
    bar.update(k, fmt::format("start {} of {}", k + 1, options.seeds));
    const std::uint64_t seed = options.seed + static_cast<std::uint64_t>(k);
    attempts.push_back({seed, planner.plan(seed)});
  }
  return attempts;
}

void print_attempts(const std::vector<Attempt>& attempts) {
  std::vector<std::vector<std::string>> rows = {{"seed", "status", "knots", "iterations", "time s",
                                                 "duration s", "cost", "tip error cm",
                                                 "tip speed cm/s"}};
  for (const Attempt& attempt : attempts) {
    const Plan& plan = attempt.plan;
    rows.push_back({fmt::format("{}", attempt.seed), std::string(plan::status_name(plan.status)),
                    fmt::format("{}", plan.knots.times.size()), fmt::format("{}", plan.iterations),
                    fmt::format("{:.2f}", plan.seconds)});
    if (!plan.found() && plan.status != plan::PlanStatus::not_met_on_replay) continue;
    for (const double value : {plan.duration(), plan.objective}) {
      rows.back().push_back(fmt::format("{:.4g}", value));
    }
    for (const double value : {plan.tip_error, plan.tip_speed}) {
      rows.back().push_back(fmt::format("{:.3f}", 100.0 * value));
    }
  }
  fmt::print("{}tip error and tip speed: at the end of a simulation with the planned torques\n",
             format_table(rows));
}

// The plan of least cost; null if there is none.
const Attempt* best_of(const std::vector<Attempt>& attempts) {
  const Attempt* best = nullptr;
  for (const Attempt& attempt : attempts) {
    if (!attempt.plan.found()) continue;
    if (best == nullptr || attempt.plan.objective < best->plan.objective) best = &attempt;
  }
  return best;
}

[[noreturn]] void give_up(const std::vector<Attempt>& attempts) {
  const plan::PlanStatus status = attempts.front().plan.status;
  const bool alike = std::ranges::all_of(
      attempts, [&](const Attempt& attempt) { return attempt.plan.status == status; });
  const Plan& first = attempts.front().plan;
  const std::string missed =
      first.status == plan::PlanStatus::not_met_on_replay
          ? fmt::format(", the simulated motion ends {:.3g} mm from the goal at {:.3g} mm/s",
                        1e3 * first.tip_error, 1e3 * first.tip_speed)
          : "";
  throw Error(
      ErrorKind::not_converged, {.item = "plan"},
      fmt::format("no plan was found from {} start{}: {}", attempts.size(),
                  attempts.size() == 1 ? "" : "s",
                  alike ? std::string(plan::status_name(status)) + missed : "see the table"),
      "increase --duration, --seeds, --intervals or the tolerances, use --free-duration, or raise "
      "the torque limits");
}

// Times and torques in the form of signal files, which are linear between rows.
std::string torque_table(const ArmScene& scene, const Plan& plan) {
  std::vector<std::string> names = {"time [s]"};
  for (const std::string& input : scene.inputs) names.push_back(input + " [N m]");
  std::string text;
  append_csv_header(text, names);
  std::vector<double> row(names.size());
  const auto add = [&](double time, Eigen::Index knot) {
    row[0] = time;
    for (std::size_t u = 1; u < row.size(); ++u) {
      row[u] = plan.knots.torque(knot, static_cast<Eigen::Index>(u) - 1);
    }
    append_csv_row(text, row);
  };
  const VectorX& times = plan.knots.times;
  const bool constant = plan.method == CollocationMethod::backward_euler;
  if (!constant) add(times[0], 0);
  for (Eigen::Index k = 1; k < times.size(); ++k) {
    // The constant torque of an interval is that at its end.
    const double jump = k == 1 ? 0.0 : kJump * (times[k] - times[k - 1]);
    if (constant) add(times[k - 1] + jump, k);
    add(times[k], k);
  }
  return text;
}

nlohmann::ordered_json rows_of(const MatrixX& values) {
  auto rows = nlohmann::ordered_json::array();
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const VectorX row = values.row(i);
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

nlohmann::ordered_json to_json(const ArmScene& scene, const PlanTask& task,
                               const std::vector<Attempt>& attempts) {
  const auto list = [](const VectorX& v) { return std::vector<double>(v.begin(), v.end()); };
  nlohmann::ordered_json json = {{"scene", scene.description.name},
                                 {"body", scene.arm->settings().name},
                                 {"goal_m", list(task.goal.position)},
                                 {"method", plan::method_name(task.grid.method)},
                                 {"actuators", scene.inputs}};
  for (const Attempt& attempt : attempts) {
    nlohmann::ordered_json one = {{"seed", attempt.seed},
                                  {"status", plan::status_name(attempt.plan.status)},
                                  {"iterations", attempt.plan.iterations},
                                  {"seconds", attempt.plan.seconds},
                                  {"corrections", attempt.plan.corrections},
                                  {"cost", attempt.plan.objective},
                                  {"duration_s", attempt.plan.duration()},
                                  {"tip_error_m", attempt.plan.tip_error},
                                  {"tip_speed_m_s", attempt.plan.tip_speed},
                                  {"planned_tip_error_m", attempt.plan.planned_tip_error},
                                  {"planned_tip_speed_m_s", attempt.plan.planned_tip_speed}};
    json["starts"].push_back(std::move(one));
  }
  const Attempt* best = best_of(attempts);
  if (best == nullptr) return json;
  json["seed"] = best->seed;
  json["tip_error_m"] = best->plan.tip_error;
  json["tip_speed_m_s"] = best->plan.tip_speed;
  json["times_s"] = list(best->plan.knots.times);
  json["torque_N_m"] = rows_of(best->plan.knots.torque);
  const Replay replay = plan::replay(scene.arm, task, best->plan);
  json["replay"] = {{"times_s", list(replay.times)},
                    {"torque_N_m", rows_of(replay.torque)},
                    {"tip_m", rows_of(replay.tip)},
                    {"tip_velocity_m_s", rows_of(replay.tip_velocity)}};
  return json;
}

void say_how_to_play(const PlanOptions& options, const ArmScene& scene, const Plan& plan) {
  const std::string table = std::filesystem::absolute(options.out).lexically_normal().string();
  fmt::print("wrote {}; to run it:\n  sinew run {} --duration {:.6g}s", options.out,
             options.scene.file.string(), plan.duration());
  for (const std::string& set : options.scene.overrides) fmt::print(" \\\n    --set '{}'", set);
  for (const std::string& input : scene.inputs) {
    fmt::print(" \\\n    --set 'actuators.{}.command.torque={{file: {}, column: {}}}'", input,
               table, input);
  }
  fmt::print("\n");
}

int make_plan(const PlanOptions& options) {
  require_range("--seeds", options.seeds, 1, kMaxSeeds);
  const ArmScene scene = load_arm_scene(options.scene);
  require_inputs(scene);
  const PlanTask task = task_of(options, scene);
  print_left_out(scene);
  const std::vector<Attempt> attempts = search(options, scene, task);
  if (attempts.empty()) return 0;  // interrupted
  print_attempts(attempts);
  const nlohmann::ordered_json json = to_json(scene, task, attempts);
  if (options.json) write_file(*options.json, json.dump(2) + "\n");
  const Attempt* best = best_of(attempts);
  if (best == nullptr) give_up(attempts);
  if (!options.out.empty()) {
    write_file(options.out, torque_table(scene, best->plan));
    say_how_to_play(options, scene, best->plan);
  }
  return options.plot.empty() ? 0 : draw_json("plan", json.dump(), options.plot);
}

}  // namespace

void add_plan(CommandLine& line) {
  Command command = line.add_command("plan", "Plan joint torques that move an arm's tip to a goal");
  const auto options = std::make_shared<PlanOptions>();
  add_arm_scene_options(command, options->scene);
  command.add_option("--goal", options->goal, "Goal of the tip, e.g. \"20 0 -40 cm\"")
      .required()
      .type_name("POINT");
  command.add_option("--duration", options->duration, "Duration of the motion (default: 1.6s)")
      .type_name("TIME");
  command.add_flag("--free-duration", options->free_duration,
                   "Optimise the duration, from half to twice --duration");
  command
      .add_option("--rate-limit", options->rate_limit,
                  "Limit on the rate of every torque, besides the scene's, e.g. 2Nm/s")
      .type_name("RATE");
  command
      .add_option("--tolerance", options->tolerance,
                  "Distance of the tip from the goal at the end (default: 2mm)")
      .type_name("LENGTH");
  command
      .add_option("--speed-tolerance", options->speed_tolerance,
                  "Speed of the tip at the end (default: 5mm/s)")
      .type_name("SPEED");
  command
      .add_option("--method", options->method,
                  "Collocation method: radau or backward-euler (default: radau)")
      .type_name("NAME");
  command.add_option("--intervals", options->intervals, "Initial number of intervals (default: 50)")
      .type_name("N");
  command
      .add_option("--seeds", options->seeds,
                  "Number of random starts; keep the cheapest plan (default: 1)")
      .type_name("N");
  command.add_option("--seed", options->seed, "Random seed of the first start (default: 1)")
      .type_name("S");
  command.add_option("--json", options->json, "Also write the results as JSON").type_name("FILE");
  command.add_option("-o,--out", options->out, "Write times and torques as CSV, for scenes")
      .type_name("FILE");
  command.add_option("--plot", options->plot, "Plot torques and tip path to a PNG file")
      .type_name("FILE");
  command.footer(
      "Uses the scene's actuators of type torque, within their limits.\n\n"
      "Example:\n"
      "  sinew plan examples/fluidic_arm/arm.yaml --goal \"20 0 -40 cm\" --rate-limit 2Nm/s -o "
      "plan.csv");
  command.set_action([options] { return make_plan(*options); });
}

}  // namespace sinew::cli
