/// @file
/// What a high-rate loop reads its input from and writes its output to.
#pragma once

#include "sinew/control/high_rate_step.hpp"

namespace sinew::control {

/// Called in the loop's thread once a period: neither may wait.
class Device {
 public:
  virtual ~Device() = default;
  /// Puts the latest measurement into sensors, hands and driven of an input; targets are not its
  /// own. @return false where there is none since the last call.
  virtual bool read(HighRateInput& input) = 0;
  virtual void write(const HighRateOutput& output) = 0;
};

}  // namespace sinew::control
