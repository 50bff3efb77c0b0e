/// @file
/// Looks at a simulation that leave nothing behind.
#pragma once

#include <utility>

#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state.hpp"
#include "sinew/sim/world.hpp"

namespace sinew::sim {

/// Calls look(state), which may change the simulation's state and the world's problem, and puts
/// both back, also where it throws. @param simulation that is looked at. @param look takes the
/// State before. @return what it returns.
template <class Look>
auto query(Simulation& simulation, Look&& look) {
  const State state = simulation.state();
  World::Solved solved = simulation.world().keep_solved();
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
