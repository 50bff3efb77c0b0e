/// @file
/// The loads and efforts that grow along a path.
#pragma once

#include <vector>

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

/// Interpolates load factors and actuator efforts between their last applied values and the
/// commanded ones.
class PathLoads {
 public:
  /// Evaluates the commands.
  /// @param run must outlive it. Throws Error(bad-argument) if an actuator has a commanded motion
  ///   or a drive.
  explicit PathLoads(run::Run& run);
  /// Applies the loads and efforts at a fraction of the path.
  void set_fraction(double fraction);

 private:
  struct Stretch {
    double from = 0.0, to = 0.0;
  };

  run::Run& run_;
  std::vector<Stretch> loads_, efforts_;  // of the model's loads and actuators
};

}  // namespace sinew::statics
