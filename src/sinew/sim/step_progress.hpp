/// @file
/// What a step that is not done yet tells of itself.
#pragma once

#include <functional>
#include <string_view>

namespace sinew::sim {

/// By which way an equilibrium is looked for, see docs/solver.md.
enum class SearchStage {
  newton,        ///< the whole step
  held_efforts,  ///< with what a controller chose last
  last_efforts,  ///< with what a controller's actuators did in the last step
  parts,         ///< along loads and commands in parts
  downhill,      ///< with the projected tangent
  overdamped,    ///< by overdamped motion: solve_static() alone
};
/// The stage in words: "along the load in parts".
std::string_view search_stage_text(SearchStage stage);

struct StepProgress {
  SearchStage stage = SearchStage::newton;
  int iterations = 0;              ///< of Newton, since the step began
  double relative_residual = 0.0;  ///< after the last of them
  double seconds = 0.0;            ///< since the step began
};

/// Called at every iteration of Newton's and of contacts, in the thread that steps. What it throws
/// ends the step.
using StepWatcher = std::function<void(const StepProgress&)>;

}  // namespace sinew::sim
