/// @file
/// Settings and points of Simulation::follow_path().
#pragma once

namespace sinew::sim {

struct PathSettings {
  double first_step = 0.01;    ///< largest motion of any coordinate, relative to the robot's size
  double largest_step = 0.05;  ///< the same for all later steps
  double tolerance = 1e-9;     ///< residual relative to the loads
  int max_points = 500;
};

/// An equilibrium on the path to the full load.
struct PathPoint {
  double load_fraction = 0.0;  ///< fraction of loads and efforts, 0 at the start, 1 at full load
  int negative_pivots = 0;     ///< number of unstable directions
};

}  // namespace sinew::sim
