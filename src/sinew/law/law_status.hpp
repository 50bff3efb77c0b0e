/// @file
/// Status of the solution of a step's law.
#pragma once

namespace sinew::law {

/// Status of the solution of a step's law.
enum class LawStatus {
  solved,
  limits_conflict,  ///< limits contradict each other in this step; they are violated least
  failed,           ///< no efforts could be found
};

}  // namespace sinew::law
