/// @file
/// Shows recorded states of a run on a simulation.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::viewer {

/// The state of a recorded run at one time.
struct RecordedState {
  /// The recorded values of an observable.
  struct Value {
    std::size_t observable;       ///< index in the list of the playback
    std::vector<double> numbers;  ///< (size of the observable,)
  };
  std::vector<Value> values;  ///< at least positions (of an arm coordinates), efforts and motions
  std::int64_t step = 0;
};

/// Replaces the state of a simulation by recorded states.
class Playback {
 public:
  /// @param simulation,observables of one robot; must outlive this.
  Playback(sim::Simulation& simulation, sim::Observables& observables)
      : simulation_(simulation), observables_(observables) {}

  /// Shows a recorded state. Values that were not recorded are computed with zero velocities.
  /// Throws Error(malformed-file) for numbers of another robot.
  void show(const RecordedState& recorded);

 private:
  void check(const RecordedState& recorded) const;
  void put_body(const run::Observable& what, const std::vector<double>& numbers,
                run::State& state) const;
  void put_poses(const RecordedState& recorded, run::State& state) const;
  void put_actuator(const run::Observable& what, double number, run::State& state);

  sim::Simulation& simulation_;
  sim::Observables& observables_;
};

}  // namespace sinew::viewer
