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

/// Samples sensors as a run goes on. They only look: a run takes the same bits with and without
/// them.
class Sensors {
 public:
  /// @param model outlives them.
  explicit Sensors(const Model& model);

  bool empty() const { return sensors_.empty(); }
  /// At the start of a run.
  void restart(const Run& run);
  /// After a step.
  void advance(const Run& run);
  /// After a search for an equilibrium: the robot has rested there, see Channel::settle().
  void settle(const Run& run);

  const Channel& channel(int index) const { return at(index).channel; }
  Channel& channel(int index) { return sensors_[static_cast<std::size_t>(index)].channel; }
  /// What a sensor without errors and delay would say. @param run now. @param index of
  /// Model::sensors(). @param values (size,), replaced.
  void read_true(const Run& run, int index, std::span<double> values) const;

  /// All that changes, finite numbers; nothing without sensors.
  void save(std::vector<double>& memory) const;
  /// Takes it up again. @return whether it is of the same sensors; else nothing has changed but
  /// what restart() renews.
  bool load(std::span<const double> memory);

 private:
  struct Sensor {
    const SensorModel* model;
    Channel channel;
    std::vector<double> memory;  // of the source
    std::size_t row = 0;         // of the record, the next one
    std::vector<double> truth;
  };
  const Sensor& at(int index) const { return sensors_[static_cast<std::size_t>(index)]; }
  static void sample(const Run& run, Sensor& sensor);
  static void replay(const Run& run, Sensor& sensor);

  double signature_;  // tells sets of sensors apart in states
  std::vector<Sensor> sensors_;
};

}  // namespace sinew::sim
