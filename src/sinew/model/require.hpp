/// @file
/// Range check of a drive's parameters.
#pragma once

namespace sinew::model {

/// Throws Error(out-of-range) unless a condition holds. @param holds the condition.
/// @param what,value name and value of the parameter. @param remedy what to give instead.
void require(bool holds, const char* what, double value, const char* remedy);

}  // namespace sinew::model
