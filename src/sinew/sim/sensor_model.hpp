/// @file
/// Sensors of a model: what each measures, and through what channel.
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
  std::vector<double> times;     ///< (n,) s, when each was taken
  MatrixX values;                ///< (n, size) in SI; a NaN: missing
};

/// Immutable part of a sensor.
struct SensorModel {
  std::string name;
  std::string kind;        ///< its type in scenes: "marker", "cable-length"
  std::string observable;  ///< what it reads: "long_0.displacement"; its own NAME.true, where that
                           ///< is observed by nothing else
  std::shared_ptr<const SensorSource> source;
  ChannelSettings channel;
  std::shared_ptr<const SensorRecord> record = {};  ///< that replaces the source; null: none
};

}  // namespace sinew::sim
