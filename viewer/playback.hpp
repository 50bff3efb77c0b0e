/// @file
/// Recorded moments of a run, shown in place of a simulation's own.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/sim/observables.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::viewer {

/// A moment of a recorded run.
struct RecordedState {
  /// What was recorded of an observable.
  struct Value {
    std::size_t observable;       ///< of the list that is played back into
    std::vector<double> numbers;  ///< as many as it has
  };
  std::vector<Value> values;  ///< at least positions, or an arm's coordinates, efforts and motions
  std::int64_t step = 0;
};

/// Puts recorded moments in place of the present one.
class Playback {
 public:
  /// @param simulation,observables of one robot; must outlive this.
  Playback(sim::Simulation& simulation, sim::Observables& observables)
      : simulation_(simulation), observables_(observables) {}

  /// What was not recorded is computed anew, with velocities of zero. Throws Error(malformed-file)
  /// for numbers of another robot.
  void show(const RecordedState& recorded);

 private:
  void check(const RecordedState& recorded) const;
  void put_body(const sim::Observable& what, const std::vector<double>& numbers,
                sim::State& state) const;
  void put_poses(const RecordedState& recorded, sim::State& state) const;
  void put_actuator(const sim::Observable& what, double number, sim::State& state);

  sim::Simulation& simulation_;
  sim::Observables& observables_;
};

}  // namespace sinew::viewer
