// sinew identify: an arm's masses, stiffness, damping and actuators from motion capture.
#include <algorithm>
#include <cmath>
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
#include "sinew/identify/arm_fit.hpp"
#include "sinew/pcc/arm.hpp"
#include "sinew/scene/scene.hpp"

#include "arguments.hpp"
#include "arm_scene.hpp"
#include "commands.hpp"
#include "python_tool.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

using identify::ArmFit;
using identify::ArmFitSettings;
using identify::MotionRecord;
using identify::RecordFit;

constexpr int kMaxStarts = 1000;
constexpr Dimension kAngularDamping{2, 1, -1};  // N m s
constexpr Dimension kCubic{-7, 1, -2};          // N m/m^9

struct IdentifyOptions {
  ArmSceneOptions scene;
  std::vector<std::string> records, validate;
  std::vector<std::string> fixed;
  bool passive = false, moving = false;
  std::optional<std::string> coefficient, delay, damping, time_step;
  std::optional<double> mass_spread, stiffness_spread;
  int starts = 1;
  std::uint64_t seed = 1;
  std::optional<std::string> json;
  std::string out, plot;
};

bool holds_volumes(const std::string& file) {
  CsvSettings settings;
  settings.allow_non_finite = settings.allow_empty = true;
  const Table table = read_csv(file, settings);
  return std::ranges::any_of(table.names, [](const auto& n) { return n.starts_with("volume_"); });
}

// Reads a record, and checks that its inputs match the model: none, torques, or volumes.
MotionRecord read_record(const std::string& file, const IdentifyOptions& options,
                         const ArmScene& scene) {
  MotionRecord record = identify::read_motion_record(file, scene.arm->segments());
  if (options.passive) {
    record.input.resize(record.samples(), 0);
    return record;
  }
  const Eigen::Index inputs = record.input.cols(), wanted = std::ssize(scene.inputs);
  if (inputs == 0) {
    throw Error(ErrorKind::wrong_columns, {.file = file},
                "no column torque_0 or volume_0: the inputs of the arm are unknown",
                "add a column for each actuator, or give --passive if the arm was not actuated");
  }
  if (inputs != wanted) {
    throw Error(ErrorKind::wrong_columns, {.file = file},
                fmt::format("the record has {} inputs, but the scene's arm has {} torque actuators",
                            inputs, wanted),
                wanted == 0 ? "add actuators of type torque to the scene, or give --passive"
                            : fmt::format("give a column for each of {}, numbered from 0",
                                          fmt::join(scene.inputs, ", ")));
  }
  const bool volumes = holds_volumes(file);
  if (volumes != options.coefficient.has_value()) {
    throw Error(ErrorKind::bad_argument, {.file = file, .item = "--coefficient"},
                volumes ? "the inputs are volumes, and their relation to torque is not given"
                        : "the inputs are torques, which need no coefficient",
                volumes ? "give an initial guess of c in torque = c volume^3: --coefficient 4e12"
                        : "omit --coefficient");
  }
  return record;
}

std::vector<MotionRecord> read_records(const std::vector<std::string>& files,
                                       const IdentifyOptions& options, const ArmScene& scene) {
  std::vector<MotionRecord> records;
  for (const std::string& file : files) records.push_back(read_record(file, options, scene));
  return records;
}

ArmFitSettings settings_of(const IdentifyOptions& options) {
  ArmFitSettings settings;
  settings.fixed = options.fixed;
  if (options.moving) settings.start = identify::RecordStart::moving;
  if (options.mass_spread) settings.mass_spread = *options.mass_spread;
  if (options.stiffness_spread) settings.stiffness_spread = *options.stiffness_spread;
  if (options.damping) {
    const auto range = parse_list(*options.damping, kAngularDamping, 2, {.item = "--damping"});
    settings.damping_lower = range[0];
    settings.damping_upper = range[1];
  }
  if (options.time_step) {
    settings.step.time_step =
        positive_quantity("--time-step", *options.time_step, dimension::kTime);
  }
  require_range("--starts", options.starts, 1, kMaxStarts);
  settings.search.starts = options.starts;
  settings.search.seed = options.seed;
  return settings;
}

identify::ArmModel model_of(const IdentifyOptions& options, const ArmScene& scene) {
  identify::ArmModel model{scene.arm, {}};
  if (options.passive) {  // else the records would need inputs
    pcc::ArmSettings settings = scene.arm->settings();
    settings.actuation = MatrixX::Zero(scene.arm->coordinates(), 0);
    model.arm = std::make_shared<const pcc::Arm>(std::move(settings));
  }
  if (!options.coefficient) return model;
  pcc::FluidicActuator actuator;
  actuator.cubic = positive_quantity("--coefficient", *options.coefficient, kCubic);
  if (options.delay) {
    actuator.delay = parse_quantity(*options.delay, dimension::kTime, {.item = "--delay"});
  }
  actuator.check();
  model.actuators.assign(scene.inputs.size(), actuator);
  return model;
}

void print_records(const char* title, const std::vector<RecordFit>& records, bool fitted) {
  if (records.empty()) return;
  std::vector<std::vector<std::string>> rows = {{title, "NRMSE %", "mean error mm"}};
  if (fitted) rows.front().insert(rows.front().end(), {"summed error before m", "after m"});
  for (const RecordFit& record : records) {
    rows.push_back({record.name, fmt::format("{:.3g}", 100.0 * record.nrmse),
                    fmt::format("{:.3g}", 1e3 * record.mean_error)});
    if (!fitted) continue;
    rows.back().push_back(fmt::format("{:.4g}", record.start_summed_error));
    rows.back().push_back(fmt::format("{:.4g}", record.summed_error));
  }
  fmt::print("\n{}", format_table(rows));
}

nlohmann::ordered_json json_of(const std::vector<RecordFit>& records) {
  auto json = nlohmann::ordered_json::array();
  for (const RecordFit& record : records) {
    json.push_back({{"name", record.name},
                    {"nrmse", record.nrmse},
                    {"mean_error_m", record.mean_error},
                    {"summed_error_m", record.summed_error},
                    {"summed_error_before_m", record.start_summed_error}});
  }
  return json;
}

nlohmann::ordered_json to_json(const ArmScene& scene, const ArmFit& found,
                               const std::vector<RecordFit>& validated) {
  nlohmann::ordered_json json = {{"scene", scene.description.name},
                                 {"body", scene.arm->settings().name},
                                 {"converged", found.fit.converged},
                                 {"undetermined", found.undetermined()},
                                 {"noise_m", found.fit.noise}};
  for (Eigen::Index k = 0; k < found.own; ++k) {
    const auto& p = found.fit.parameters[static_cast<std::size_t>(k)];
    nlohmann::ordered_json one = {{"name", p.name},         {"unit", p.unit},
                                  {"value", p.value},       {"fixed", p.fixed},
                                  {"at_bound", p.at_bound}, {"determined", p.determined}};
    if (!p.fixed && !p.at_bound && p.determined) {
      one["standard_error"] = p.standard_error;
      one["interval"] = {p.interval_lower, p.interval_upper};
    }
    json["parameters"].push_back(std::move(one));
  }
  json["records"] = json_of(found.records);
  json["validated"] = json_of(validated);
  return json;
}

// Measured and predicted positions of the ends in each record; missing ones are null.
std::string plot_data(const std::vector<MotionRecord>& measured,
                      const std::vector<RecordFit>& predicted, std::size_t fitted) {
  auto json = nlohmann::json::array();
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const auto columns = [](const MatrixX& values) {
      auto list = nlohmann::json::array();
      for (Eigen::Index c = 0; c < values.cols(); ++c) {
        const VectorX column = values.col(c);
        list.push_back(std::vector<double>(column.begin(), column.end()));
      }
      return list;
    };
    const VectorX& time = measured[k].time;
    json.push_back({{"name", measured[k].name},
                    {"fitted", k < fitted},
                    {"nrmse", predicted[k].nrmse},
                    {"time", std::vector<double>(time.begin(), time.end())},
                    {"measured", columns(measured[k].position)},
                    {"predicted", columns(predicted[k].predicted)}});
  }
  return nlohmann::json{{"records", std::move(json)}}.dump();
}

// The scene with the identified arm.
std::string scene_yaml(const IdentifyOptions& options, const ArmScene& scene, const ArmFit& found) {
  const pcc::ArmSettings& settings = found.model.arm->settings();
  scene::Node tree = scene.description.tree;
  for (std::size_t k = 0; k < settings.segments.size(); ++k) {
    const pcc::Segment& segment = settings.segments[k];
    const auto set = [&](const char* key, double value, const char* unit) {
      scene::apply_override(
          tree, fmt::format("bodies.{}.segments.{}.{}={} {}", settings.name, k, key, value, unit));
    };
    set("mass", segment.mass, "kg");
    set("stiffness", segment.stiffness, "N m");
    set("damping", segment.damping, "N m s");
    if (!segment.extensible) continue;
    set("axial_stiffness", segment.axial_stiffness, "N/m");
    set("axial_damping", segment.axial_damping, "N s/m");
  }
  scene::resolve_paths(tree, std::filesystem::absolute(options.scene.file).parent_path());
  std::string text = fmt::format("# {} with the arm '{}' as identified by sinew identify from",
                                 options.scene.file.filename().string(), settings.name);
  for (const RecordFit& record : found.records) {
    text += fmt::format(" {} (NRMSE {:.2g} %)", record.name, 100.0 * record.nrmse);
  }
  for (std::size_t u = 0; u < found.model.actuators.size(); ++u) {
    const pcc::FluidicActuator& actuator = found.model.actuators[u];
    text += fmt::format("\n# {}: torque = {} N m/m^9 volume^3, {} s late", scene.inputs[u],
                        actuator.cubic, actuator.delay);
  }
  return text + "\n" + scene::to_yaml(tree);
}

int run_identify(const IdentifyOptions& options) {
  const ArmScene scene = load_arm_scene(options.scene);
  const ArmFitSettings settings = settings_of(options);
  const identify::ArmModel model = model_of(options, scene);
  std::vector<MotionRecord> records = read_records(options.records, options, scene);
  const std::vector<MotionRecord> others = read_records(options.validate, options, scene);
  print_left_out(scene);
  std::fflush(stdout);
  ArmFit found;
  std::vector<RecordFit> validated;
  {
    ProgressBar bar(2, true);
    bar.update(0, "fitting");
    found = identify::fit_arm(model, records, settings);
    bar.update(1, "validating");
    if (!others.empty()) {
      validated = identify::validate_arm(found.model, others, settings.step);
    }
  }
  fmt::print("{}", identify::fit_table(found.fit, found.own));
  print_records("fit", found.records, true);
  print_records("validation", validated, false);
  if (options.json) {
    write_file(*options.json, to_json(scene, found, validated).dump(2) + "\n");
  }
  if (!options.out.empty()) {
    write_file(options.out, scene_yaml(options, scene, found));
    fmt::print("wrote {}\n", options.out);
  }
  if (options.plot.empty()) return 0;
  std::vector<RecordFit> shown = found.records;
  shown.insert(shown.end(), validated.begin(), validated.end());
  records.insert(records.end(), others.begin(), others.end());
  return draw_json("identify", plot_data(records, shown, found.records.size()), options.plot);
}

}  // namespace

void add_identify(CommandLine& line) {
  Command command = line.add_command(
      "identify", "Identify masses, stiffness and damping of an arm from motion data");
  const auto options = std::make_shared<IdentifyOptions>();
  add_arm_scene_options(command, options->scene);
  command
      .add_option("RECORD", options->records,
                  "CSV of motion: time [s], x_0 [mm], z_0 [mm], x_1 [mm] ..., and torque_0 [N m] "
                  "or volume_0 [ml] ... in the order of the scene's actuators")
      .type_name("FILE")
      .required();
  command
      .add_option("--fixed", options->fixed,
                  "Parameters to keep at the scene's values, e.g. mass_1,stiffness")
      .delimiter(',')
      .type_name("NAMES")
      .allow_extra_args(false);
  command.add_flag("--passive", options->passive, "The arm was not actuated; ignore input columns");
  command.add_flag("--moving", options->moving, "Records start in motion (default: at rest)");
  command
      .add_option("--coefficient", options->coefficient,
                  "Volume inputs: initial guess of c in torque = c volume^3, N m/m^9")
      .type_name("C");
  command
      .add_option("--delay", options->delay,
                  "Volume inputs: initial guess of the actuator delay (default: 0s)")
      .type_name("TIME");
  command
      .add_option("--mass-spread", options->mass_spread,
                  "Bounds on masses, as a fraction of the scene's (default: 0.38)")
      .type_name("X");
  command
      .add_option("--stiffness-spread", options->stiffness_spread,
                  "Bounds on stiffness, as a fraction of the scene's (default: 0.23)")
      .type_name("X");
  command
      .add_option("--damping", options->damping, "Bounds on damping (default: \"1e-3 5e-3 N m s\")")
      .type_name("RANGE");
  command
      .add_option("--time-step", options->time_step, "Time step of the simulation (default: 5ms)")
      .type_name("TIME");
  command
      .add_option("--starts", options->starts,
                  "Starts of the fit: the scene's values, then random (default: 1)")
      .type_name("N");
  command.add_option("--seed", options->seed, "Random seed of the starts (default: 1)")
      .type_name("S");
  command
      .add_option("--validate", options->validate,
                  "Record for validation, not used in the fit (repeatable)")
      .type_name("RECORD")
      .allow_extra_args(false);
  command.add_option("--json", options->json, "Also write the results as JSON").type_name("FILE");
  command.add_option("-o,--out", options->out, "Write the scene with the identified arm as YAML")
      .type_name("FILE");
  command.add_option("--plot", options->plot, "Plot measured and predicted motion to a PNG file")
      .type_name("FILE");
  command.footer(
      "Example:\n"
      "  sinew identify arm.yaml take_1.csv take_2.csv --fixed mass_1 --validate take_3.csv -o "
      "identified.yaml");
  command.set_action([options] { return run_identify(*options); });
}

}  // namespace sinew::cli
