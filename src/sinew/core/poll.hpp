/// @file
/// How whoever waits for long work looks in on it, and ends it.
#pragma once

#include <functional>

namespace sinew {

/// Called again and again by work that may take long, in the thread that was asked for it. What it
/// throws ends the work: whoever was asked takes back what the work has changed, and lets it pass.
using Poll = std::function<void()>;

}  // namespace sinew
