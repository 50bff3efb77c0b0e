/// @file
/// Errors of a step or search.
#pragma once

#include <string>

#include "sinew/core/error.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::world {
struct JointConflict;
}

namespace sinew::statics {

class FreeMotion;

/// Restores `before` of the run and throws an error that names the step and the bodies.
[[noreturn]] void fail(run::Run& run, ErrorKind kind, const std::string& message,
                       const std::string& remedy);
/// The same with the text of a motion that nothing resists after the message; throws
/// FreeMotionError.
[[noreturn]] void fail_free(run::Run& run, const FreeMotion& free, const std::string& message,
                            const std::string& remedy);
/// The same if no efforts satisfy the laws.
[[noreturn]] void fail_law(run::Run& run);
/// The same if joints and prescribed motions contradict each other.
[[noreturn]] void fail_joints(run::Run& run, const world::JointConflict& conflict);

}  // namespace sinew::statics
