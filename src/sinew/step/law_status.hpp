/// @file
/// How the law of a step was solved.
#pragma once

namespace sinew::step {

/// How solving went.
enum class LawStatus {
  solved,
  limits_conflict,  ///< limits contradict each other in this step; the least violation was taken
  failed,           ///< no efforts could be found
};

}  // namespace sinew::step
