/// @file
/// Sensors of a model: sources and channels.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/channel.hpp"

namespace sinew::sim {

class SensorSource;

/// Samples of a real sensor, in the order of their arrival.
struct SensorRecord {
  std::vector<double> arrivals;  ///< (n,) s, not decreasing
  std::vector<double> times;     ///< (n,) s, when each sample was taken
  MatrixX values;                ///< (n, size) in SI units; NaN: missing
};

/// The immutable part of a sensor.
struct SensorModel {
  std::string name;
  std::string kind;        ///< type in scenes: "marker", "cable-length"
  std::string observable;  ///< observable that it measures: "long_0.displacement"; its own
                           ///< NAME.true if there is no other
  std::shared_ptr<const SensorSource> source;
  ChannelSettings channel;
  std::shared_ptr<const SensorRecord> record = {};  ///< replaces the source; null: none
};

}  // namespace sinew::sim
