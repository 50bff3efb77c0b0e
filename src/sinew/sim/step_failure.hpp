/// @file
/// How a step or a search ends that cannot go on.
#pragma once

#include <string>

#include "sinew/core/error.hpp"

namespace sinew::sim {

struct JointConflict;
struct Run;

/// Goes back to `before` of a run and throws, with the step and the bodies.
[[noreturn]] void fail(Run& run, ErrorKind kind, const std::string& message,
                       const std::string& remedy);
/// The same where no efforts obey the law.
[[noreturn]] void fail_law(Run& run);
/// And where joints and what moves them contradict each other.
[[noreturn]] void fail_joints(Run& run, const JointConflict& conflict);

}  // namespace sinew::sim
