/// @file
/// Programs solved from nearby: primal-dual interior-point steps in full, without a search along
/// them, on sparse conditions of optimality that are factored along their chain.
#pragma once

#include <optional>

#include "sinew/plan/nonlinear_program.hpp"

namespace sinew::plan {

/// The algorithm of Ipopt (Waechter & Biegler 2006, sec. 2 and 3.1) with Mehrotra's probing barrier
/// (Nocedal, Waechter & Waltz, SIAM J. Optimization 19, 2009), but every step is taken to the
/// boundary: near a solution the search only shortens steps that were good. Nothing where it does
/// not converge, or comes to a point that is no number: the search is then needed.
/// @param program to solve. @param start with multipliers. @param settings tolerance.
std::optional<ProgramResult> solve_nearby(NonlinearProgram& program, const ProgramPoint& start,
                                          const SolverSettings& settings);

}  // namespace sinew::plan
