#include "sinew/control/inverse_status.hpp"

#include "sinew/core/whole.hpp"

namespace sinew::control {

std::string_view inverse_status_name(InverseStatus status) {
  switch (status) {
    case InverseStatus::not_started:
      return "not-started";
    case InverseStatus::on_target:
      return "on-target";
    case InverseStatus::moving:
      return "moving";
    case InverseStatus::rate_limited:
      return "rate-limited";
    case InverseStatus::out_of_reach:
      return "out-of-reach";
    case InverseStatus::local_optimum:
      return "local-optimum";
    case InverseStatus::limits_conflict:
      return "limits-conflict";
    case InverseStatus::at_limits:
      return "at-limits";
    case InverseStatus::holding:
      return "holding";
    case InverseStatus::held_back:
      return "held-back";
  }
  return "unknown";
}

InverseStatus inverse_status_of(double number) {
  return static_cast<InverseStatus>(whole<int>(number, 0, kInverseStatuses - 1));
}

}  // namespace sinew::control
