// sinew reach: the positions at which an arm's tip can be held at rest.
#include <cstdint>
#include <cstdio>
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
#include "sinew/plan/reach.hpp"

#include "arguments.hpp"
#include "arm_limits.hpp"
#include "arm_scene.hpp"
#include "commands.hpp"
#include "python_tool.hpp"
#include "terminal.hpp"

namespace sinew::cli {

namespace {

constexpr int kMaxSamples = 10'000'000;

struct ReachOptions {
  ArmSceneOptions scene;
  int samples = 1000;
  std::uint64_t seed = 1;
  std::vector<std::string> goals;
  std::optional<std::string> json;
  std::string out, plot;
};

struct GoalReach {
  Vector3 goal = Vector3::Zero();
  plan::NearestReach nearest;
  bool proven = false;  ///< whether a proof was tried: segments that bend in space have none
  plan::ReachProof proof;
};

std::vector<Vector3> goals_of(const ReachOptions& options, const pcc::Arm& arm) {
  std::vector<Vector3> goals;
  for (const std::string& text : options.goals) {
    plan::PlanTask task;
    task.goal.position = parse_vector3(text, dimension::kLength, {.item = "--goal"});
    goals.push_back(plan::completed(arm, std::move(task)).goal.position);
  }
  return goals;
}

plan::ArmLimits torque_limits(const ArmScene& scene) {
  plan::ArmLimits limits = limits_of(scene);
  for (std::size_t u = 0; u < scene.inputs.size(); ++u) {
    const auto at = static_cast<Eigen::Index>(u);
    if (limits.torque_lower[at] > -plan::kNoBound && limits.torque_upper[at] < plan::kNoBound) {
      continue;
    }
    throw Error(ErrorKind::out_of_range, {.item = fmt::format("actuators.{}", scene.inputs[u])},
                "the torque has no limits",
                "write limits: {torque: {min: -0.1 N m, max: 0.1 N m}}");
  }
  return plan::completed_limits(*scene.arm, limits);
}

bool is_planar(const pcc::Arm& arm) {
  for (const pcc::Segment& segment : arm.settings().segments) {
    if (segment.bending != pcc::Bending::planar) return false;
  }
  return true;
}

std::string centimetres(const Vector3& point) {
  const Vector3 shown = (1e4 * point).array().round() * 1e-2;
  return fmt::format("{:.2f} {:.2f} {:.2f}", shown.x() + 0.0, shown.y() + 0.0, shown.z() + 0.0);
}

void print_reach(const plan::ReachMap& map, const std::vector<GoalReach>& goals) {
  if (map.tip.rows() > 0) {
    fmt::print("{} stable equilibria, tips from {} to {} cm\n", map.tip.rows(),
               centimetres(map.tip.colwise().minCoeff()),
               centimetres(map.tip.colwise().maxCoeff()));
  } else {
    fmt::print("no stable equilibrium found\n");
  }
  if (goals.empty()) return;
  std::vector<std::vector<std::string>> rows = {
      {"goal cm", "nearest at rest cm", "distance cm", "stable", "proof", "boxes"}};
  for (const GoalReach& reach : goals) {
    const plan::NearestReach& nearest = reach.nearest;
    rows.push_back({centimetres(reach.goal), nearest.found ? centimetres(nearest.tip) : "none",
                    nearest.found ? fmt::format("{:.2f}", 100.0 * nearest.distance) : "",
                    nearest.found ? (nearest.stable ? "yes" : "no") : "",
                    reach.proven ? std::string(plan::verdict_name(reach.proof.verdict)) : "none",
                    reach.proven ? fmt::format("{}", reach.proof.boxes) : ""});
  }
  fmt::print("\n{}", format_table(rows));
  fmt::print(
      "out-of-reach: no equilibrium has its tip within {:g} cm of the goal along each axis\n",
      100.0 * plan::ReachProofSettings{}.tolerance);
}

std::string reach_table(const ArmScene& scene, const plan::ReachMap& map) {
  std::vector<std::string> names = {"x [m]", "y [m]", "z [m]"};
  for (Eigen::Index i = 0; i < map.position.cols(); ++i) {
    names.push_back(fmt::format("angle_{} [rad]", i));
  }
  for (const std::string& input : scene.inputs) names.push_back(input + " [N m]");
  std::string text;
  append_csv_header(text, names);
  for (Eigen::Index k = 0; k < map.tip.rows(); ++k) {
    std::vector<double> row;
    for (const double value : map.tip.row(k)) row.push_back(value);
    for (const double value : map.position.row(k)) row.push_back(value);
    for (const double value : map.torque.row(k)) row.push_back(value);
    append_csv_row(text, row);
  }
  return text;
}

nlohmann::ordered_json to_json(const ArmScene& scene, const plan::ReachMap& map,
                               const std::vector<GoalReach>& goals) {
  const auto list = [](const auto& v) { return std::vector<double>(v.begin(), v.end()); };
  nlohmann::ordered_json json = {{"scene", scene.description.name},
                                 {"body", scene.arm->settings().name},
                                 {"actuators", scene.inputs},
                                 {"goals", nlohmann::ordered_json::array()},
                                 {"tip_m", nlohmann::ordered_json::array()}};
  for (const GoalReach& reach : goals) {
    nlohmann::ordered_json one = {{"goal_m", list(reach.goal)}, {"found", reach.nearest.found}};
    if (reach.nearest.found) {
      one["distance_m"] = reach.nearest.distance;
      one["stable"] = reach.nearest.stable;
      one["tip_m"] = list(reach.nearest.tip);
      one["angle_rad"] = list(reach.nearest.position);
      one["torque_N_m"] = list(reach.nearest.torque);
    }
    if (reach.proven) {
      one["proof"] = plan::verdict_name(reach.proof.verdict);
      one["boxes"] = reach.proof.boxes;
    }
    json["goals"].push_back(std::move(one));
  }
  for (Eigen::Index k = 0; k < map.tip.rows(); ++k) json["tip_m"].push_back(list(map.tip.row(k)));
  return json;
}

int reach(const ReachOptions& options) {
  require_range("--samples", options.samples, 1, kMaxSamples);
  const ArmScene scene = load_arm_scene(options.scene);
  require_inputs(scene);
  const plan::ArmLimits limits = torque_limits(scene);
  const std::vector<Vector3> wanted = goals_of(options, *scene.arm);
  const bool provable = is_planar(*scene.arm);
  print_left_out(scene);
  std::fflush(stdout);
  plan::ReachMap map;
  std::vector<GoalReach> goals;
  {
    ProgressBar bar(std::ssize(wanted) + 1, true);
    bar.update(0, "equilibria under random torques");
    map = plan::sample_reach(scene.arm, limits, options.samples, options.seed);
    for (const Vector3& goal : wanted) {
      bar.update(std::ssize(goals) + 1, fmt::format("goal {}", goals.size() + 1));
      GoalReach one{goal, plan::nearest_reach(scene.arm, limits, goal), provable, {}};
      if (provable) one.proof = plan::prove_out_of_reach(scene.arm, limits, goal);
      goals.push_back(std::move(one));
    }
  }
  print_reach(map, goals);
  const nlohmann::ordered_json json = to_json(scene, map, goals);
  if (options.json) write_file(*options.json, json.dump(2) + "\n");
  if (!options.out.empty()) {
    write_file(options.out, reach_table(scene, map));
    fmt::print("wrote {}\n", options.out);
  }
  return options.plot.empty() ? 0 : draw_json("reach", json.dump(), options.plot);
}

}  // namespace

void add_reach(CommandLine& line) {
  Command command = line.add_command("reach", "Compute the static workspace of an arm's tip");
  const auto options = std::make_shared<ReachOptions>();
  add_arm_scene_options(command, options->scene);
  command
      .add_option("--samples", options->samples, "Number of random torque samples (default: 1000)")
      .type_name("N");
  command.add_option("--seed", options->seed, "Random seed (default: 1)").type_name("S");
  command
      .add_option("--goal", options->goals,
                  "Find the equilibrium nearest to this point, or prove that none is near, e.g. "
                  "\"20 0 -40 cm\" (repeatable)")
      .type_name("POINT")
      .allow_extra_args(false);
  command.add_option("--json", options->json, "Also write the results as JSON").type_name("FILE");
  command.add_option("-o,--out", options->out, "Write tip positions, angles and torques as CSV")
      .type_name("FILE");
  command.add_option("--plot", options->plot, "Plot the reachable points to a PNG file")
      .type_name("FILE");
  command.footer(
      "Torques are sampled within the limits of the scene's actuators of type torque; segments\n"
      "without an actuator are passive.\n\n"
      "Example:\n"
      "  sinew reach examples/fluidic_arm/arm.yaml --goal \"20 0 -40 cm\" --plot reach.png");
  command.set_action([options] { return reach(*options); });
}

}  // namespace sinew::cli
