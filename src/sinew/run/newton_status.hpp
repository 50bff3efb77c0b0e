/// @file
/// How a Newton iteration ended.
#pragma once

#include <string_view>

namespace sinew::run {

enum class NewtonStatus {
  converged,
  iteration_limit,  ///< settings.max_iterations reached
  stalled,          ///< the line search found no acceptable step length
  inverted,         ///< even a short step would invert an element
  singular,         ///< A cannot be factorised
  law_failed,       ///< the law has no solution for the efforts
  unphysical,       ///< it converged, but no robot has such a state, see Sanity
};
/// "converged", "iteration-limit", ...
std::string_view newton_status_name(NewtonStatus status);

}  // namespace sinew::run
