/// @file
/// A check of a drive's numbers.
#pragma once

namespace sinew::sim {

/// Throws Error(out-of-range) unless a condition holds. @param holds whether it does.
/// @param what,value the number that it is about. @param remedy what to give instead.
void require(bool holds, const char* what, double value, const char* remedy);

}  // namespace sinew::sim
