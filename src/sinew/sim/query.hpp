/// @file
/// Queries of a simulation that leave it unchanged.
#pragma once

#include <utility>

#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/world/world.hpp"

namespace sinew::sim {

/// Calls look(state), which may change the simulation's state and the world's problem, and restores
/// both afterwards, even after an exception. @param simulation to be queried. @param look takes the
/// State before the query. @return the result of `look`.
template <class Look>
auto query(Simulation& simulation, Look&& look) {
  const run::State state = simulation.state();
  world::World::Solved solved = simulation.world().keep_solved();
  const auto put_back = [&] {  // no destructor, since restore() may throw
    simulation.restore(state);
    simulation.world().put_back(std::move(solved));
  };
  try {
    auto result = look(state);
    put_back();
    return result;
  } catch (...) {
    put_back();
    throw;
  }
}

}  // namespace sinew::sim
