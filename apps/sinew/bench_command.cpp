// sinew bench: times the stages of a step, without recording.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/build_info.hpp"
#include "sinew/core/file.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/law/step_problem.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/tangent.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

#include "arguments.hpp"
#include "commands.hpp"
#include "eigen_reference.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

constexpr int kMaxSteps = 10'000'000;
constexpr int kWarmUp = 20;           // steps, if no target defines the duration of a turn
constexpr double kEigenBudget = 5.0;  // s, about

struct BenchOptions {
  SceneOptions scene;
  int steps = 300;
  std::optional<int> warm_up;
  std::optional<std::string> json, tangent;
  bool compare_eigen = false;
};

// The measurements; times in s.
struct Samples {
  std::array<std::vector<double>, world::kStageCount + 1> stages;  // the last one is the whole step
  double error_sum = 0.0, error_max = 0.0;                         // m or rad
  double residual_max = 0.0;                                       // relative
  double distance_max = 0.0;                                       // m, see StepReport::distance
  int active_set_changes = 0;
  std::vector<double> eigen;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

const char* stage_name(std::size_t stage) {
  return stage < world::kStageCount ? world::kStageNames[stage] : "total";
}

// Reads which actuators are slack or at a limit, which is the visible part of the active set.
void read_active_set(const sim::Simulation& simulation, std::vector<int>& active) {
  active.clear();
  for (std::size_t a = 0; a < simulation.model().actuators().size(); ++a) {
    const model::ActuatorState& state = simulation.actuator(static_cast<int>(a));
    const law::ActuatorBlock& range = simulation.actuator_blocks()[a];
    const auto at = [](double value, double limit) {
      return std::abs(value - limit) <= 1e-9 * (1.0 + std::abs(limit));
    };
    active.push_back((at(state.effort, range.effort_min) ? 1 : 0) +
                     (at(state.effort, range.effort_max) ? 2 : 0));
  }
}

int warm_up_steps(const BenchOptions& options, const Session& session) {
  if (options.warm_up) return *options.warm_up;
  const double turn = session.first_turn() / session.robot().model->step().time_step;
  return std::max(kWarmUp, whole<int>(turn, 0, 100000));
}

void measure_steps(const BenchOptions& options, Session& session, int warm_up, Samples& samples) {
  std::vector<int> before, active;
  const Interrupt interrupt;
  const int steps = warm_up + options.steps;
  ProgressBar bar(steps, true);
  std::int64_t i = 0;
  const sim::Watched watched = watch_steps(session.simulation(), bar, i);
  for (; i < steps; ++i) {
    Interrupt::check();
    session.step();
    const run::StepReport& report = session.simulation().report();
    before.swap(active);
    read_active_set(session.simulation(), active);
    if (i < warm_up) continue;
    for (std::size_t s = 0; s < world::kStageCount; ++s) {
      samples.stages[s].push_back(report.times.seconds[s]);
    }
    samples.stages.back().push_back(report.times.total);
    samples.residual_max = std::max(samples.residual_max, report.relative_residual);
    samples.distance_max = std::fmax(samples.distance_max, report.distance);
    samples.error_sum += session.error();
    samples.error_max = std::max(samples.error_max, session.error());
    samples.active_set_changes += active == before ? 0 : 1;
  }
}

Samples measure(const BenchOptions& options, Session& session, int warm_up) {
  Samples samples;
  for (auto& stage : samples.stages) stage.reserve(static_cast<std::size_t>(options.steps));
  try {
    measure_steps(options, session, warm_up, samples);
  } catch (const Interrupted&) {  // results so far are kept
  }
  if (!options.compare_eigen || samples.stages.back().empty()) return samples;
  const double once = eigen_factorisation_times(session.simulation(), 1).front();
  samples.eigen =
      eigen_factorisation_times(session.simulation(), whole<int>(kEigenBudget / once, 3, 100));
  return samples;
}

nlohmann::ordered_json to_json(const Samples& samples, Session& session, int warm_up) {
  const model::Model& model = *session.robot().model;
  const auto steps = samples.stages.back().size();
  nlohmann::ordered_json json = {
      {"scene", session.robot().description.name},
      {"steps", steps},
      {"warm_up_steps", warm_up},
      {"threads", session.simulation().threads()},
      {"machine", processor()},
      {"instruction_set", instruction_set()},
      {"compiler", compiler()},
      {"sinew_version", version()},
      {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
      {"tangent", mechanics::tangent_name(model.step().tangent)}};
  for (const auto& body : model.bodies()) {
    const mesh::Mesh* mesh = body.has_mesh() ? &body.mesh() : nullptr;
    json["bodies"].push_back({{"name", body.name()},
                              {"nodes", mesh != nullptr ? mesh->node_count() : 0},
                              {"tetrahedra", mesh != nullptr ? mesh->tetrahedra.size() : 0}});
  }
  for (std::size_t s = 0; s < samples.stages.size(); ++s) {
    json["stages"][stage_name(s)] = {{"median_us", 1e6 * quantile(samples.stages[s], 0.5)},
                                     {"p95_us", 1e6 * quantile(samples.stages[s], 0.95)}};
  }
  if (session.controller() != nullptr) {
    json["mean_error_m"] = samples.error_sum / static_cast<double>(steps);
    json["max_error_m"] = samples.error_max;
    json["active_set_changes"] = samples.active_set_changes;
  }
  json["max_relative_residual"] = samples.residual_max;
  json["max_distance_m"] = samples.distance_max;
  json["bytes_per_simulation"] = session.simulation().bytes();
  if (!samples.eigen.empty()) {
    const double eigen = quantile(samples.eigen, 0.5);
    json["eigen_simplicial_ldlt"] = {{"median_us", 1e6 * eigen},
                                     {"repeats", samples.eigen.size()},
                                     {"ratio", quantile(samples.stages.back(), 0.5) / eigen}};
  }
  return json;
}

void print_report(const nlohmann::ordered_json& json) {
  fmt::print("{}: {} steps after {} warm-up steps, {} thread{}, {} tangent\n{}, {}, {}, {}\n\n",
             json["scene"].get<std::string>(), json["steps"].get<int>(),
             json["warm_up_steps"].get<int>(), json["threads"].get<int>(),
             json["threads"] == 1 ? "" : "s", json["tangent"].get<std::string>(),
             json["machine"].get<std::string>(), json["instruction_set"].get<std::string>(),
             json["compiler"].get<std::string>(), json["date"].get<std::string>());
  std::vector<std::vector<std::string>> rows = {{"stage", "median us", "95 % us"}};
  for (const auto& [name, times] : json["stages"].items()) {
    rows.push_back({name == "factorisation" ? "factorisation with W" : name,
                    fmt::format("{:.1f}", times["median_us"].get<double>()),
                    fmt::format("{:.1f}", times["p95_us"].get<double>())});
  }
  if (json.contains("eigen_simplicial_ldlt")) {
    const auto& eigen = json["eigen_simplicial_ldlt"];
    rows.push_back(
        {"Eigen SimplicialLDLT", fmt::format("{:.1f}", eigen["median_us"].get<double>())});
    rows.push_back({"whole step / Eigen's", fmt::format("{:.3f}", eigen["ratio"].get<double>())});
  }
  fmt::print("{}\n", format_table(rows));
  rows.clear();
  if (json.contains("mean_error_m")) {
    rows.push_back({"mean, max error",
                    fmt::format("{:.3g}, {:.3g} mm", 1e3 * json["mean_error_m"].get<double>(),
                                1e3 * json["max_error_m"].get<double>())});
    rows.push_back(
        {"active set changes", fmt::format("{}", json["active_set_changes"].get<int>())});
  }
  rows.push_back({"max relative residual",
                  fmt::format("{:.2e}", json["max_relative_residual"].get<double>())});
  if (const double distance = json["max_distance_m"].get<double>(); distance > 0.0) {
    rows.push_back({"max distance to the solution", fmt::format("{:.3g} mm", 1e3 * distance)});
  }
  rows.push_back({"memory per simulation",
                  fmt::format("{:.2f} MB", 1e-6 * json["bytes_per_simulation"].get<double>())});
  fmt::print("{}", format_table(rows));
}

void check_options(const BenchOptions& options) {
  require_range("--steps", options.steps, 1, kMaxSteps);
  if (options.warm_up) require_range("--warm-up", *options.warm_up, 0, kMaxSteps);
  if (options.tangent && !mechanics::tangent_of(*options.tangent)) {
    throw Error(ErrorKind::unknown_choice, {.item = "--tangent"},
                fmt::format("there is no tangent '{}'", *options.tangent),
                "write exact, projected or corotated");
  }
}

int bench(const BenchOptions& options) {
  check_options(options);
  SceneOptions scene = options.scene;
  if (options.tangent) scene.overrides.push_back("solver.tangent=" + *options.tangent);
  Session session(scene);
  const int warm_up = warm_up_steps(options, session);
  const Samples samples = measure(options, session, warm_up);
  if (samples.stages.back().empty()) {
    throw Error(ErrorKind::bad_argument, {.item = "bench"},
                "interrupted before the first measured step", "reduce --warm-up or --steps");
  }
  const nlohmann::ordered_json json = to_json(samples, session, warm_up);
  if (options.json) write_file(*options.json, json.dump(2) + "\n");
  print_report(json);
  return 0;
}

}  // namespace

void add_bench(CommandLine& line) {
  Command command = line.add_command("bench", "Measure the time of each stage of a step");
  const auto options = std::make_shared<BenchOptions>();
  add_scene_options(command, options->scene);
  command.add_option("--steps", options->steps, "Steps to measure (default: 300)").type_name("N");
  command
      .add_option("--warm-up", options->warm_up,
                  "Warm-up steps, not measured (default: the first cycle of the targets, else 20)")
      .type_name("N");
  command.add_option("--json", options->json, "Also write the results as JSON").type_name("FILE");
  command
      .add_option("--tangent", options->tangent,
                  "Tangent: exact, projected or corotated (default: the scene's)")
      .type_name("NAME");
  command.add_flag("--compare-eigen", options->compare_eigen,
                   "Also measure Eigen's SimplicialLDLT on the same matrix, on one thread");
  command.footer(
      "Example:\n"
      "  sinew bench trunk.yaml --steps 400 --threads 1 --compare-eigen --json bench.json");
  command.set_action([options] { return bench(*options); });
}

}  // namespace sinew::cli
