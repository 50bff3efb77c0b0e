/// @file
/// Which actuators' limits contradict each other, in words.
#pragma once

#include <string>

#include "sinew/qp/elastic.hpp"
#include "sinew/sim/law.hpp"

namespace sinew::inverse {

/// "displacement of 'east' leaves -0.01..0.01 m by 0.003 m; tension of 'east' is at 3 N".
/// @param problem whose actuators have the program's variables and rows, one each.
/// @param program with efforts over `scale` (actuators,) as variables.
/// @param nearest its solution: rows that are relaxed, and the bounds that stand against them.
std::string describe_conflict(const sim::LawProblem& problem, const qp::QuadraticProgram& program,
                              const VectorX& scale, const qp::ElasticResult& nearest);

}  // namespace sinew::inverse
