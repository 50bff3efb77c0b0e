#include "sinew/sim/solve_law.hpp"

#include <algorithm>

namespace sinew::sim {

LawStatus solve_law(World& world, Law& law, const LawProblem& problem, std::span<double> effort) {
  if (!world.guesses_contacts()) return law.solve(problem, effort);
  const std::span<double> before = world.kept_effort();
  std::ranges::copy(effort, before.begin());  // a law may look back at the last step
  while (true) {
    const LawStatus status = law.solve(problem, effort);
    if (status == LawStatus::failed) return status;
    world.solve_motion(effort);
    if (!world.correct_contacts(effort)) return status;
    std::ranges::copy(before, effort.begin());
  }
}

}  // namespace sinew::sim
