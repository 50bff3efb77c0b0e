/// @file
/// The requirement on every scene, whatever it combines: it runs, and the run can be reproduced.
#pragma once

#include <cstdint>
#include <string>

#include "features.hpp"

namespace sinew::combine {

/// The result of trying a scene.
struct Outcome {
  enum class Kind {
    ran,      ///< it ran, and was reproduced in every way
    refused,  ///< it was refused before its first step
    stopped,  ///< an error in a step stopped it, reproduced in every way
    wrong,    ///< a step does not meet StepCheck, or a result was not reproduced
  };
  Kind kind = Kind::ran;
  std::string cause;      ///< unless `ran`
  std::string condition;  ///< worst status of a step
};

/// "ran", "refused", "stopped", "wrong".
const char* outcome_name(Outcome::Kind kind);

/// Runs the scene of a selection for a few steps, checks each one (StepCheck), records it and reads
/// the record back. Then
/// repeats the run with two threads, from a state saved half-way, from a copy made half-way, after
/// reset(), with other names, and in another order. @param selection,seed see draft_scene().
Outcome try_scene(const Selection& selection, std::uint64_t seed);

/// Runs the symmetric scene of a selection (draft_symmetric_scene()), checks each step, and
/// compares both sides of the robot at the end: nodes, tensions of opposite cables, forces of
/// contacts.
/// @param selection,seed see draft_symmetric_scene().
Outcome try_symmetric_scene(const Selection& selection, std::uint64_t seed);

/// Changes a random number of the scene by a few per cent. A state of the original scene must then
/// be refused, or continue as in the original. Numbers of inputs (commands, load factors, targets)
/// and of the solver are not changed, since a state is independent of them.
/// @param selection,seed see draft_scene(). @return description of the defect; empty if there is
/// none.
std::string try_changed_number(const Selection& selection, std::uint64_t seed);

}  // namespace sinew::combine
