/// @file
/// What a scene must do whatever it combines: run, and do the same again.
#pragma once

#include <cstdint>
#include <string>

#include "features.hpp"

namespace sinew::combine {

/// What became of a scene.
struct Outcome {
  enum class Kind {
    ran,      ///< and did the same again in every way
    refused,  ///< before its first step
    stopped,  ///< by an error in a step, the same in every way
    wrong,    ///< not finite, or not the same again
  };
  Kind kind = Kind::ran;
  std::string cause;      ///< of all but `ran`
  std::string condition;  ///< the worst status of a step
};

/// "ran", "refused", "stopped", "wrong".
const char* outcome_name(Outcome::Kind kind);

/// Takes the scene of a selection a few steps, records it and reads the record back, and again:
/// with two threads, from a state saved half-way, from a copy made half-way, after reset(), under
/// other names, in another order.
/// @param selection,seed see draft_scene().
Outcome try_scene(const Selection& selection, std::uint64_t seed);

/// Changes a number of the scene by a few per cent, whichever the seed draws: a state of the scene
/// as it was must be refused then, or go on as it would have. Numbers of inputs (commands, factors
/// of loads, targets) and of the solver are left out: a state may meet others.
/// @return what is wrong; empty: nothing.
std::string try_changed_number(const Selection& selection, std::uint64_t seed);

}  // namespace sinew::combine
