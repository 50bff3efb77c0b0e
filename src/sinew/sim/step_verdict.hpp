/// @file
/// Whether a step has solved its equation.
#pragma once

#include "sinew/sim/step_status.hpp"

namespace sinew::sim {

struct Run;

/// Whether forces balance at the end of the step that the report of a run describes: Newton's
/// method decides; if it had few iterations or was not used, the residual decides.
bool is_balanced(const Run& run);
/// unphysical or not-in-equilibrium for a step that failed; see is_failure().
StepStatus failure_status(const Run& run);

}  // namespace sinew::sim
