/// @file
/// The way of a convex homotopy: what is lacking to equilibrium is taken away in steps.
#pragma once

#include <functional>

namespace sinew::sim {

/// How to go along the path r(q, lambda) = s r_start, from s = 1 to 0 (Allgower & Georg, Numerical
/// Continuation Methods, 1990, 1.3).
struct LoadSteps {
  double first = 0.25;        ///< step of s
  double min = 1.0 / 256;     ///< steps shorter than this end the search
  double min_at_first = 0.0;  ///< the same, before any step has succeeded
};

/// Halves the step after each failure, and doubles it after a success: where that fails at once,
/// after twice as many successes as the last time. Returns the s that is left: 0 when the end was
/// reached.
/// @param steps see there. @param solve whether there is an equilibrium at an s, which is then the
/// present
///   state. @param keep the present state is one to come back to. @param go_back to the
///   last state that was kept, or to the start.
double take_load_steps(const LoadSteps& steps, const std::function<bool(double)>& solve,
                       const std::function<void()>& keep, const std::function<void()>& go_back);

}  // namespace sinew::sim
