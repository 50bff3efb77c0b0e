/// @file
/// States as parts of a list of numbers.
#pragma once

#include <span>
#include <vector>

namespace sinew::run {
struct State;
}

namespace sinew::estimate {

/// Appends a state as finite numbers, for take(). @param state of a simulation.
/// @param numbers in and out.
void append(const run::State& state, std::vector<double>& numbers);
/// Reads a state from the front of `numbers`, which is shortened.
/// @param state of the same model, in and out. @param numbers in and out.
/// @return whether the state was complete.
bool take(run::State& state, std::span<const double>& numbers);

}  // namespace sinew::estimate
