/// @file
/// Counts every `new` of this test program, including aligned ones, on all threads.
#pragma once

#include <cstddef>

namespace sinew::fem {

std::size_t allocation_count();

}  // namespace sinew::fem
