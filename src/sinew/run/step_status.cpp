#include "sinew/run/step_status.hpp"

namespace sinew::run {

std::string_view step_status_name(StepStatus status) {
  switch (status) {
    case StepStatus::solved:
      return "solved";
    case StepStatus::limits_conflict:
      return "limits-conflict";
    case StepStatus::command_not_reached:
      return "command-not-reached";
    case StepStatus::cavitates:
      return "cavitates";
    case StepStatus::cut_back:
      return "cut-back";
    case StepStatus::not_in_equilibrium:
      return "not-in-equilibrium";
    case StepStatus::gaining_energy:
      return "gaining-energy";
    case StepStatus::after_failure:
      return "after-failure";
    case StepStatus::unphysical:
      return "unphysical";
  }
  return "unknown";
}

std::string step_status_remedy(StepStatus status, const model::StepSettings& step) {
  const bool newton = step.method == model::Method::newton;
  const std::string method = !newton                                     ? "`solver: newton`"
                             : step.tangent != mechanics::Tangent::exact ? "`tangent: exact`"
                                                                         : "";
  const std::string use = method.empty() ? "" : ", or use " + method;
  switch (status) {
    case StepStatus::solved:
      return "";
    case StepStatus::limits_conflict:
      return "loosen the limits that contradict each other";
    case StepStatus::command_not_reached:
      return "change the command more slowly" + use;
    case StepStatus::cavitates:
      return "draw less volume out of the chamber, command its pressure, or correct its "
             "`ambient_pressure`";
    case StepStatus::cut_back:
      return "take a smaller time step, change commands more slowly, or refine the mesh";
    case StepStatus::not_in_equilibrium:
      return "take a smaller time step, or change commands more slowly" + use;
    case StepStatus::after_failure:
      return "go back to the last solved state: the way here led through a step that failed";
    case StepStatus::unphysical:
      return "command a motion (a volume_growth, a displacement) in place of an effort, or use "
             "dynamics with a small time step" +
             use;
    case StepStatus::gaining_energy:
      return "take a smaller time step" + use;
  }
  return "";
}

}  // namespace sinew::run
