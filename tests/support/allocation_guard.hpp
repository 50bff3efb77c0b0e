// Counts the allocations of a test program by malloc and related functions, including operator new.
#pragma once

namespace sinew::testing {

/// Whether allocations are counted; false in sanitizer builds, which replace these functions.
bool counts_allocations();
/// Number of allocations so far, on all threads.
long allocations();

}  // namespace sinew::testing
