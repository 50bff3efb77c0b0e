/// @file
/// Interface of the devices of a high-rate loop.
#pragma once

#include "sinew/high_rate/high_rate_step.hpp"

namespace sinew::high_rate {

/// A device that measures the input of a loop and applies its output. The loop's thread calls both
/// functions once per period, so neither may block.
class Device {
 public:
  virtual ~Device() = default;
  /// Writes the latest measurement to the sensors, hands and driven efforts of `input`. Targets do
  /// not belong to the device. @return false if there is no new measurement since the last call.
  virtual bool read(HighRateInput& input) = 0;
  virtual void write(const HighRateOutput& output) = 0;
};

}  // namespace sinew::high_rate
