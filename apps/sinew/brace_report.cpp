#include "brace_report.hpp"

#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/core/csv.hpp"
#include "sinew/pcc/arm_equations.hpp"

namespace sinew::cli {

namespace {

using plan::Brace;
using plan::BraceRun;
using plan::BraceTask;

constexpr int kPosePoints = 8;  // per segment of a drawn pose

using Json = nlohmann::ordered_json;

Json list(const VectorX& v) { return std::vector<double>(v.begin(), v.end()); }

Json conditions_json(const Brace& brace) {
  Json result = Json::array();
  if (brace.object < 0) return result;
  for (const plan::BraceCondition& condition : brace.conditions) {
    result.push_back({{"name", condition.name},
                      {"verdict", plan::verdict_name(condition.verdict)},
                      {"value", condition.value},
                      {"limit", condition.limit}});
  }
  return result;
}

Json object_json(const constraint::SmoothSurface& surface, const std::string& name) {
  Json result = {{"name", name}};
  if (const auto* plane = std::get_if<constraint::Plane>(&surface)) {
    result["plane"] = {{"point_m", list(plane->point)}, {"normal", list(plane->normal)}};
  } else if (const auto* sphere = std::get_if<constraint::Sphere>(&surface)) {
    result["capsule"] = {{"ends_m", {list(sphere->centre), list(sphere->centre)}},
                         {"radius_m", sphere->radius}};
  } else {
    const auto& capsule = std::get<constraint::Capsule>(surface);
    result["capsule"] = {{"ends_m", {list(capsule.from), list(capsule.to)}},
                         {"radius_m", capsule.radius}};
  }
  return result;
}

/// The axis of the arm at a time of the run.
Json pose_json(const ArmScene& scene, const BraceRun& run, const char* label, double time) {
  pcc::ArmEquations equations(scene.arm);
  Eigen::Index row = 0;
  (run.times.array() - time).abs().minCoeff(&row);
  const VectorX angles = run.position.row(row), still = VectorX::Zero(angles.size());
  Json points = Json::array({list(scene.arm->settings().base)});
  for (int segment = 0; segment < scene.arm->segments(); ++segment) {
    for (int k = 1; k <= kPosePoints; ++k) {
      const double fraction = static_cast<double>(k) / kPosePoints;
      points.push_back(list(
          equations.point({.segment = segment, .fraction = fraction}, angles, still).position));
    }
  }
  return {{"label", label}, {"time_s", run.times[row]}, {"axis_m", std::move(points)}};
}

Json errors_json(const BraceRun& run, const Vector3& goal) {
  Json times = Json::array(), errors = Json::array();
  for (Eigen::Index k = 0; k < run.times.size(); ++k) {
    if (run.times[k] < run.disturbed_from) continue;
    times.push_back(run.times[k] - run.disturbed_from);
    errors.push_back((run.tip.row(k).transpose() - goal).norm());
  }
  return {{"times_s", std::move(times)}, {"error_m", std::move(errors)}};
}

}  // namespace

std::string brace_table(const ArmScene& scene, const BraceRun& run) {
  std::vector<std::string> names = {"time [s]", "tip.x [m]", "tip.y [m]", "tip.z [m]"};
  for (Eigen::Index i = 0; i < run.position.cols(); ++i) {
    names.push_back(fmt::format("angle_{} [rad]", i));
  }
  for (const std::string& input : scene.inputs) names.push_back(input + " [N m]");
  names.insert(names.end(), {"normal_force [N]", "friction_force [N]"});
  std::string text;
  append_csv_header(text, names);
  for (Eigen::Index k = 0; k < run.times.size(); ++k) {
    std::vector<double> row = {run.times[k]};
    for (const double value : run.tip.row(k)) row.push_back(value);
    for (const double value : run.position.row(k)) row.push_back(value);
    for (const double value : run.torque.row(k)) row.push_back(value);
    row.insert(row.end(), {run.normal_force[k], run.friction_force[k]});
    append_csv_row(text, row);
  }
  return text;
}

nlohmann::ordered_json brace_json(const ArmScene& scene, const BraceTask& task,
                                  const std::vector<std::string>& names, const Brace& brace,
                                  const std::vector<BraceTrial>& trials) {
  Json json = {{"scene", scene.description.name},
               {"body", scene.arm->settings().name},
               {"goal_m", list(task.goal)},
               {"status", plan::status_name(brace.status)},
               {"conditions", conditions_json(brace)},
               {"objects", Json::array()},
               {"actuators", scene.inputs}};
  for (std::size_t k = 0; k < names.size(); ++k) {
    json["objects"].push_back(object_json(task.objects[k].surface, names[k]));
  }
  if (!brace.found()) return json;
  json["segments"] = brace.segments;
  json["object"] = names[static_cast<std::size_t>(brace.object)];
  json["place_m"] = list(brace.place);
  json["force_N"] = list(brace.force);
  json["normal_force_N"] = brace.normal_force;
  json["friction_force_N"] = brace.friction_force;
  json["hold_force_N"] = brace.hold_force;
  json["tip_compliance_m_N"] = brace.tip_compliance;
  json["peak_compliance_m_N"] = brace.peak_compliance;
  json["angle_rad"] = list(brace.position);
  json["torque_N_m"] = list(brace.torque);
  for (const BraceTrial& trial : trials) {
    json["runs"].push_back({{"seed", trial.seed},
                            {"status", plan::status_name(trial.braced.status)},
                            {"slips", trial.braced.slips},
                            {"spread_m", trial.braced.spread},
                            {"error_m", trial.braced.mean_error},
                            {"not_braced_spread_m", trial.bare.spread},
                            {"not_braced_error_m", trial.bare.mean_error}});
  }
  if (trials.empty()) return json;
  const BraceRun& run = trials.front().braced;
  json["poses"] = {pose_json(scene, run, "start", 0.0),
                   pose_json(scene, run, "contact", run.contact_time),
                   pose_json(scene, run, "pressed", run.replan_time),
                   pose_json(scene, run, "at the goal", run.disturbed_from)};
  json["braced"] = errors_json(run, task.goal);
  json["not_braced"] = errors_json(trials.front().bare, task.goal);
  json["force"] = {{"times_s", list(run.times)},
                   {"normal_N", list(run.normal_force)},
                   {"friction_N", list(run.friction_force)}};
  return json;
}

}  // namespace sinew::cli
