/// @file
/// What grows along a path.
#pragma once

#include <vector>

namespace sinew::sim {

struct Run;

/// Factors of loads and efforts of actuators, from what acted last to what they are told to be.
class PathLoads {
 public:
  /// Reads commands. @param run outlives it. Throws Error(bad-argument) where an actuator is told a
  /// motion or has a drive.
  explicit PathLoads(Run& run);
  /// Where loads and efforts stand at a fraction of the way.
  void set_fraction(double fraction);

 private:
  struct Stretch {
    double from = 0.0, to = 0.0;
  };

  Run& run_;
  std::vector<Stretch> loads_, efforts_;  // of the model's loads and actuators
};

}  // namespace sinew::sim
