// Counts the allocations of a test program: malloc and its relatives, aligned ones, operator new.
#pragma once

namespace sinew::testing {

/// False in sanitizer builds, where the sanitizer has these functions.
bool counts_allocations();
/// Allocations so far, of all threads.
long allocations();

}  // namespace sinew::testing
