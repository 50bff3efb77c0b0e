/// @file
/// Whether a step has solved its equation.
#pragma once

#include "sinew/run/step_status.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::step {

/// Whether forces balance at the end of the step that the report of a run describes: Newton's
/// method decides. One linearisation must leave no larger residual than
/// following steps do; the bound of its distance is reported.
bool is_balanced(const run::Run& run);
/// Whether the reactions of what is fixed balance the loads, contacts and joints in a quasi-static
/// step, in force and moment. This takes no search at its word: the resultant is summed from the
/// forces themselves, and only a residual that was reported excuses it, |sum r| <= sqrt(3 n) |r|.
bool reactions_balance(run::Run& run);
/// unphysical or not-in-equilibrium for a step that failed; see is_failure().
run::StepStatus failure_status(const run::Run& run);

}  // namespace sinew::step
