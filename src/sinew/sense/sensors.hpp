/// @file
/// The sensors of one simulation.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/run/instruments.hpp"
#include "sinew/sense/channel.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::sense {

struct SensorModel;
class SensorSet;

/// Samples the sensors during a run.
class Sensors : public run::Instrument {
 public:
  /// @param set must outlive them. @param run whose sensors they are.
  Sensors(const SensorSet& set, const run::Run& run);

  /// The channel of a sensor: its last sample and when it was taken. @param index in sensors_of().
  const Channel& channel(int index) const { return at(index).channel; }
  /// Writes the present reading of a sensor without errors and delay, without allocation.
  /// @param index in sensors_of(). @param values (size,), overwritten.
  void read_true(int index, std::span<double> values) const;
  /// (size,) the same. @param index in sensors_of().
  std::vector<double> truth(int index) const;
  /// Delivers a sample of a real sensor. Until begin(), such samples replace the simulated ones.
  /// Throws as Channel::receive() does.
  /// @param index in sensors_of(). @param time s, when the sample was taken. @param value (size,).
  void feed(int index, double time, std::span<const double> value);

  void begin() override;
  void advance() override;
  void settle(run::Rest rest) override;
  void save(std::vector<double>& memory) const override;
  void load(std::span<const double> memory) override;
  std::vector<run::Reading> readings() const override;

 private:
  struct Sensor {
    const SensorModel* model;
    Channel channel;
    std::vector<double> memory;  // of the source
    std::size_t row = 0;         // next row of the record
    std::vector<double> truth;
  };
  const Sensor& at(int index) const { return sensors_[static_cast<std::size_t>(index)]; }
  void sample(Sensor& sensor);
  void replay(Sensor& sensor);
  bool take(std::span<const double> memory);

  const run::Run& run_;
  std::vector<Sensor> sensors_;
};

/// The sensors of a simulation, const if it is. Throws Error(unknown-name) if it has none.
/// @param simulation with sensors.
template <class Simulation>
requires requires(Simulation& s) { s.instruments().template get<Sensors>(); }
auto& sensors_of(Simulation& simulation) {
  return simulation.instruments().template get<Sensors>();
}

}  // namespace sinew::sense
