/// @file
/// States as parts of a list of numbers.
#pragma once

#include <span>
#include <vector>

namespace sinew::sim {

struct State;

/// Appends a state as finite numbers, for take(). @param state of a simulation.
/// @param numbers in and out.
void append(const State& state, std::vector<double>& numbers);
/// Reads a state from the front of `numbers`, which is shortened.
/// @param state of the same model, in and out. @param numbers in and out.
/// @return whether the state was complete.
bool take(State& state, std::span<const double>& numbers);

}  // namespace sinew::sim
