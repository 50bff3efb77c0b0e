/// @file
/// How Newton's iterations ended.
#pragma once

#include <string_view>

namespace sinew::sim {

enum class NewtonStatus {
  converged,
  iteration_limit,  ///< settings.max_iterations reached
  stalled,          ///< no step length lessens the residual
  inverted,         ///< even a short step would turn an element inside out
  singular,         ///< A cannot be factorised
  law_failed,       ///< no efforts could be found
};
/// "converged", "iteration-limit", ...
std::string_view newton_status_name(NewtonStatus status);

}  // namespace sinew::sim
