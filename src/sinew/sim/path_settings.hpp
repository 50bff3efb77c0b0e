/// @file
/// What follow_path() takes and gives.
#pragma once

namespace sinew::sim {

struct PathSettings {
  double first_step = 0.01;    ///< largest motion of any coordinate in it, of the robot's size
  double largest_step = 0.05;  ///< the same of every later one
  double tolerance = 1e-9;     ///< residual relative to the loads
  int max_points = 500;
};

/// An equilibrium on the way to the full load.
struct PathPoint {
  double load_fraction = 0.0;  ///< of the loads and efforts, 0 at the start, 1 at the end
  int negative_pivots = 0;     ///< directions in which it is unstable
};

}  // namespace sinew::sim
