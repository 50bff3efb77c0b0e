/// @file
/// The yardstick of `sinew bench --compare-eigen`.
#pragma once

#include <vector>

#include "sinew/sim/simulation.hpp"

namespace sinew::cli {

/// Seconds that Eigen's SimplicialLDLT (AMD ordering, lower triangle of scalars) takes for its
/// numeric factorisation alone, analysis excluded, of the matrix that a step at the simulation's
/// present state factorises, on this thread; all bodies together.
/// @param simulation at rest between two steps. @param repeats how often to time; one more runs
/// first.
/// @return (repeats,) s.
std::vector<double> eigen_factorisation_times(const sim::Simulation& simulation, int repeats);

}  // namespace sinew::cli
