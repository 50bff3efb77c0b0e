/// @file
/// Callback by which the caller of long work can observe and end it.
#pragma once

#include <functional>

namespace sinew {

/// Called repeatedly by work that may take long, in the thread that called it. An exception from it
/// ends the work: the function undoes its changes and passes the exception on.
using Poll = std::function<void()>;

}  // namespace sinew
