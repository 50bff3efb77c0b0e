/// @file
/// A law's solution in a step that left points out.
#pragma once

#include <span>

#include "sinew/sim/law.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

/// Solves the law and, as long as the motion that follows takes a point that was left out into its
/// surface, takes in all of these and solves it again: what is found obeys Signorini's and
/// Coulomb's laws at all points, as if none had been left out.
/// @param world condensed. @param law,problem,effort as for Law::solve().
LawStatus solve_law(World& world, Law& law, const LawProblem& problem, std::span<double> effort);

}  // namespace sinew::sim
