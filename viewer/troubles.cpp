#include "troubles.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/control/target_controller.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::viewer {

namespace {

using Json = nlohmann::json;

/// Distance from a limit at which it counts as reached, relative to the range.
constexpr double kAtLimit = 1e-6;

bool at(double value, double limit, double scale) {
  return std::isfinite(limit) &&
         std::abs(value - limit) <= kAtLimit * std::max(scale, std::abs(limit));
}

Json trouble(const char* level, const char* kind, const std::string& subject,
             const std::string& text) {
  return {{"level", level}, {"kind", kind}, {"subject", subject}, {"text", text}};
}

void add_limits(const model::ActuatorModel& model, const model::ActuatorState& state, double time,
                Json& list) {
  const bool most = state.effort > 0.0 && at(state.effort, model.effort.max, 1e-3);
  if (most) {
    list.push_back(trouble("warning", "effort-limit", model.name,
                           fmt::format("{} is at its limit, {:.3g} {}", model.kind->effort.name,
                                       model.effort.max, model.kind->effort.unit)));
  }
  const double travel = state.motion * model.motion_scale;
  const bool far = at(travel, model.motion.max * model.motion_scale, 1e-4) ||
                   at(travel, model.motion.min * model.motion_scale, 1e-4);
  if (far && state.motion != 0.0) {
    list.push_back(trouble("warning", "motion-limit", model.name,
                           fmt::format("{} is at its limit, {:.3g} {}", model.kind->motion.name,
                                       state.motion, model.kind->motion.unit)));
  }
  // A cable without command, or the antagonist of a pulled cable, may be slack.
  if (state.slack && state.command.signal.value(time) != 0.0) {
    list.push_back(trouble("info", "slack", model.name, "the cable is slack"));
  }
}

void add_controller(const control::TargetController& controller, const std::string& name,
                    Json& list) {
  const std::string kind(control::controller_status_name(controller.status()));
  switch (controller.status()) {
    case control::ControllerStatus::not_started:
    case control::ControllerStatus::on_target:
    case control::ControllerStatus::moving:
      break;
    case control::ControllerStatus::rate_limited:
      list.push_back(trouble("info", "rate-limited", name, "on the way; rates are limited"));
      break;
    case control::ControllerStatus::out_of_reach:
      list.push_back(trouble(
          "warning", "out-of-reach", name,
          fmt::format("the target is out of reach by {:.3g} mm", 1e3 * controller.error())));
      break;
    case control::ControllerStatus::local_optimum:
      list.push_back(trouble("warning", "local-optimum", name,
                             fmt::format("no small change of efforts comes nearer than {:.3g} mm",
                                         1e3 * controller.error())));
      break;
    case control::ControllerStatus::held_back:
      list.push_back(trouble(
          "warning", "held-back", name,
          fmt::format("the robot rests {:.3g} mm from the target because larger steps fail: it "
                      "would buckle or be crushed",
                      1e3 * controller.error())));
      break;
    case control::ControllerStatus::limits_conflict:
      list.push_back(trouble("error", "limits-conflict", name,
                             "limits contradict each other: " + controller.conflict()));
      break;
    case control::ControllerStatus::at_limits:
      list.push_back(trouble("warning", "at-limits", name,
                             fmt::format("limits hold the effectors {:.3g} mm off their targets",
                                         1e3 * controller.error())));
      break;
    case control::ControllerStatus::holding:
      list.push_back(
          trouble("warning", "holding", name, "commands are held, since " + controller.conflict()));
      break;
  }
}

}  // namespace

nlohmann::json list_troubles(const sim::Simulation& simulation,
                             const control::TargetController* controller, const std::string& name) {
  Json troubles = Json::array();
  const auto& actuators = simulation.model().actuators();
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    add_limits(actuators[i], simulation.actuator(static_cast<int>(i)), simulation.time(), troubles);
  }
  if (controller != nullptr) add_controller(*controller, name, troubles);
  if (const run::StepStatus step = simulation.report().status; run::is_flagged(step)) {
    troubles.push_back(
        trouble("warning", std::string(run::step_status_name(step)).c_str(), "step",
                fmt::format("this step is {}; {}", run::step_status_name(step),
                            run::step_status_remedy(step, simulation.model().step()))));
  }
  return troubles;
}

}  // namespace sinew::viewer
