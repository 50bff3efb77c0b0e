/// @file
/// Requirements on every scene: it runs, and it gives the same results again.
#pragma once

#include <cstdint>
#include <string>

#include "features.hpp"

namespace sinew::combine {

/// Outcome of a scene.
struct Outcome {
  enum class Kind {
    ran,      ///< and gave the same results in every way
    refused,  ///< rejected before its first step
    stopped,  ///< by the same error at the same step in every way
    wrong,    ///< not finite, or not reproduced
  };
  Kind kind = Kind::ran;
  std::string cause;      ///< empty for `ran`
  std::string condition;  ///< the worst status of a step
};

/// "ran", "refused", "stopped", "wrong".
const char* outcome_name(Outcome::Kind kind);

/// Runs the scene of a selection for a few steps, records it and reads the record back. Then
/// repeats it: with two threads, from a state saved half-way, from a clone made half-way, after
/// reset(), with other names, and in another order.
/// @param selection,seed see draft_scene().
Outcome try_scene(const Selection& selection, std::uint64_t seed);

/// Changes a random number of the scene by a few per cent: a state of the original scene must then
/// be rejected, or continue as in the original. Numbers of inputs (commands, load factors, targets)
/// and of the solver are left out, since these may differ.
/// @return what is wrong; empty: nothing.
std::string try_changed_number(const Selection& selection, std::uint64_t seed);

}  // namespace sinew::combine
