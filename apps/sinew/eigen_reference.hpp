/// @file
/// The reference factorisation of `sinew bench --compare-eigen`.
#pragma once

#include <vector>

#include "sinew/sim/simulation.hpp"

namespace sinew::cli {

/// Times Eigen's SimplicialLDLT (AMD ordering, lower triangle of scalars) on the matrix of a step
/// at the current state, for all bodies together, on this thread. Only the numeric factorisation is
/// timed, without analysis. Throws Error(singular-matrix).
/// @param simulation between two steps. @param repeats number of timings; one more runs first.
/// @return (repeats,) s.
std::vector<double> eigen_factorisation_times(const sim::Simulation& simulation, int repeats);

}  // namespace sinew::cli
