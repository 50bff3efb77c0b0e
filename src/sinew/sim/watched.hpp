/// @file
/// Watches a simulation's steps for a while.
#pragma once

#include <utility>

#include "sinew/sim/simulation.hpp"
#include "sinew/sim/step_progress.hpp"

namespace sinew::sim {

/// While it lives, steps and searches tell the watcher how far they are (Simulation::watch()).
class Watched {
 public:
  /// @param simulation outlives it. @param watcher see Simulation::watch().
  Watched(Simulation& simulation, StepWatcher watcher) : simulation_(simulation) {
    simulation_.watch(std::move(watcher));
  }
  ~Watched() { simulation_.watch({}); }
  Watched(const Watched&) = delete;
  Watched& operator=(const Watched&) = delete;

 private:
  Simulation& simulation_;
};

}  // namespace sinew::sim
