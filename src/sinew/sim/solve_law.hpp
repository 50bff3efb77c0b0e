/// @file
/// A law's solution in a step that guessed which points touch, and where.
#pragma once

#include <span>

#include "sinew/sim/law.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

/// Solves the law and, as long as the motion that follows takes a point that was left out into its
/// surface, or a point is pushed by a tangent plane that is not that of its way, mends that and
/// solves it again, of the same factorisation: see World::correct_contacts().
/// @param world condensed. @param law,problem,effort as for Law::solve().
LawStatus solve_law(World& world, Law& law, const LawProblem& problem, std::span<double> effort);

}  // namespace sinew::sim
