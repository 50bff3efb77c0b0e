/// @file
/// Counts every call of operator new in this test program, aligned ones included, on all threads.
#pragma once

#include <cstddef>

namespace sinew::fem {

std::size_t allocation_count();

}  // namespace sinew::fem
