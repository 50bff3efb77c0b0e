/// @file
/// Scoped watcher of a simulation.
#pragma once

#include <utility>

#include "sinew/run/step_progress.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

/// Sets a simulation's watcher for the lifetime of the object, see Simulation::watch().
class Watched {
 public:
  /// @param simulation must outlive it. @param watcher see Simulation::watch().
  Watched(Simulation& simulation, run::StepWatcher watcher) : simulation_(simulation) {
    simulation_.watch(std::move(watcher));
  }
  ~Watched() { simulation_.watch({}); }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

 private:
  Simulation& simulation_;
};

}  // namespace sinew::sim
