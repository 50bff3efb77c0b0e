/// @file
/// Settings of a closed loop, besides those of all controllers.
#pragma once

#include <vector>

namespace sinew::control {

/// Sensors and gains of a ClosedLoop.
struct ClosedLoopSettings {
  std::vector<int> sensors;  ///< (tasks,) indices in sense::sensors_of(): that of each effector
  double gain = 5.0;         ///< 1/s, > 0: without delay, an error decays as exp(-gain t)
  double integral = 0.0;     ///< 1/s^2, >= 0: gain of the time integral of the error
  /// s, > 0: all commands are held while a sample is older than its sensor's delay plus this.
  double timeout = 0.1;
};

}  // namespace sinew::control
