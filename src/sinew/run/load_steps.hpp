/// @file
/// Step control for a convex homotopy, which removes the residual of a state in steps.
#pragma once

#include <functional>

namespace sinew::run {

/// Step lengths along the path r(q, lambda) = s r_start, from s = 1 to 0 (Allgower & Georg,
/// Numerical Continuation Methods, 1990, 1.3).
struct LoadSteps {
  double first = 0.25;        ///< initial step of s
  double min = 1.0 / 256;     ///< the search ends when the step is shorter
  double min_at_first = 0.0;  ///< the same, until a step has succeeded
};

/// Follows the path, halving the step after each failure and doubling it after a success; if a
/// doubled step fails at once, twice as many successes are required before the next doubling.
/// @param steps lengths.
/// @param solve finds the equilibrium at an s and makes it the present state; returns whether it
///   did.
/// @param keep stores the present state.
/// @param go_back restores the last stored state, or that at the start.
/// @return the remaining s: 0 if the end was reached.
double take_load_steps(const LoadSteps& steps, const std::function<bool(double)>& solve,
                       const std::function<void()>& keep, const std::function<void()>& go_back);

}  // namespace sinew::run
