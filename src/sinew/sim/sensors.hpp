/// @file
/// The sensors of one simulation.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/sim/channel.hpp"

namespace sinew::sim {

class Model;
struct Run;
struct SensorModel;

/// Samples the sensors during a run. Sensors only observe: the run is the same, bit for bit, with
/// and without them.
class Sensors {
 public:
  /// @param model must outlive them.
  explicit Sensors(const Model& model);

  bool empty() const { return sensors_.empty(); }
  /// Starts afresh, at the start of a run.
  void restart(const Run& run);
  /// Samples the sensors after a step.
  void advance(const Run& run);
  /// Samples the sensors after a search for an equilibrium, as if the robot had rested there for
  /// long; see Channel::settle().
  void settle(const Run& run);

  const Channel& channel(int index) const { return at(index).channel; }
  Channel& channel(int index) { return sensors_[static_cast<std::size_t>(index)].channel; }
  /// Reading of a sensor without errors and delay. @param run at its present time. @param index of
  /// Model::sensors(). @param values (size,), overwritten.
  void read_true(const Run& run, int index, std::span<double> values) const;

  /// Writes the state of all sensors as finite numbers; nothing without sensors.
  void save(std::vector<double>& memory) const;
  /// Restores the state. @return whether it belongs to the same sensors; if not, call restart(),
  /// which resets all that may have changed.
  bool load(std::span<const double> memory);

 private:
  struct Sensor {
    const SensorModel* model;
    Channel channel;
    std::vector<double> memory;  // of the source
    std::size_t row = 0;         // next row of the record
    std::vector<double> truth;
  };
  const Sensor& at(int index) const { return sensors_[static_cast<std::size_t>(index)]; }
  static void sample(const Run& run, Sensor& sensor);
  static void replay(const Run& run, Sensor& sensor);

  double signature_;  // tells sets of sensors apart in states
  std::vector<Sensor> sensors_;
};

}  // namespace sinew::sim
