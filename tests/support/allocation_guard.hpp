// Counts the allocations of a test program: malloc and its relatives, aligned allocations, operator
// new.
#pragma once

namespace sinew::testing {

/// False in sanitizer builds, where the sanitizer provides these functions.
bool counts_allocations();
/// Number of allocations so far, on all threads.
long allocations();

}  // namespace sinew::testing
