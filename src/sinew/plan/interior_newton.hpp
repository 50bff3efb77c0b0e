/// @file
/// Solves programs from a nearby start by primal-dual interior-point steps without line search. The
/// sparse optimality conditions are factored along their chain.
#pragma once

#include <optional>

#include "sinew/plan/nonlinear_program.hpp"

namespace sinew::plan {

/// Solves a program from a nearby start. The algorithm is that of Ipopt (Waechter & Biegler 2006,
/// sec. 2 and 3.1) with Mehrotra's probing barrier (Nocedal, Waechter & Waltz, SIAM J. Optimization
/// 19, 2009), but without line search: every step is taken to the boundary, since near a solution
/// the search only shortens good steps. Returns nothing if it does not converge or a value is not
/// finite; a solver with line search is then needed.
/// @param program to solve. @param start with multipliers. @param settings of the solver.
std::optional<ProgramResult> solve_nearby(NonlinearProgram& program, const ProgramPoint& start,
                                          const SolverSettings& settings);

}  // namespace sinew::plan
