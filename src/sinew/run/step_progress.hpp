/// @file
/// Progress reports of a step or search that is not finished.
#pragma once

#include <functional>
#include <string_view>

namespace sinew::run {

/// The method by which an equilibrium is being sought, see docs/solver.md.
enum class SearchStage {
  newton,        ///< Newton's method on the whole step
  held_efforts,  ///< with the efforts that a controller chose last
  last_efforts,  ///< with the efforts of a controller's actuators in the last step
  parts,         ///< loads and commands applied in parts
  downhill,      ///< with the projected tangent
  overdamped,    ///< overdamped motion, in solve_static() only
};
/// Describes the stage: "along the load in parts".
std::string_view search_stage_text(SearchStage stage);

/// Progress of a step or search.
struct StepProgress {
  SearchStage stage = SearchStage::newton;
  int iterations = 0;              ///< Newton iterations since the step began
  double relative_residual = 0.0;  ///< after the last iteration
  double seconds = 0.0;            ///< wall-clock time since the step began
};

/// Called at every iteration of Newton's method and of the contact solver, in the thread of the
/// step. An exception ends the step.
using StepWatcher = std::function<void(const StepProgress&)>;

}  // namespace sinew::run
