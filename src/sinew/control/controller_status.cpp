#include "sinew/control/controller_status.hpp"

#include "sinew/core/whole.hpp"

namespace sinew::control {

std::string_view controller_status_name(ControllerStatus status) {
  switch (status) {
    case ControllerStatus::not_started:
      return "not-started";
    case ControllerStatus::on_target:
      return "on-target";
    case ControllerStatus::moving:
      return "moving";
    case ControllerStatus::rate_limited:
      return "rate-limited";
    case ControllerStatus::out_of_reach:
      return "out-of-reach";
    case ControllerStatus::local_optimum:
      return "local-optimum";
    case ControllerStatus::limits_conflict:
      return "limits-conflict";
    case ControllerStatus::at_limits:
      return "at-limits";
    case ControllerStatus::holding:
      return "holding";
    case ControllerStatus::held_back:
      return "held-back";
  }
  return "unknown";
}

ControllerStatus controller_status_of(double number) {
  return static_cast<ControllerStatus>(whole<int>(number, 0, kControllerStatuses - 1));
}

}  // namespace sinew::control
