/// @file
/// A state among other numbers.
#pragma once

#include <span>
#include <vector>

namespace sinew::sim {

struct State;

/// Appends all of a state, finite numbers, as take() takes them. @param state of a simulation.
/// @param numbers in and out.
void append(const State& state, std::vector<double>& numbers);
/// Takes a state from the front of `numbers`, which it shortens. @param state of the same model, in
/// and out. @param numbers in and out. @return whether all were there.
bool take(State& state, std::span<const double>& numbers);

}  // namespace sinew::sim
