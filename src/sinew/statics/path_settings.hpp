/// @file
/// Settings and result of Simulation::follow_path().
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::statics {

struct PathSettings {
  double first_step = 0.01;    ///< largest motion of any coordinate, relative to the robot's size
  double largest_step = 0.05;  ///< the same for all later steps
  double tolerance = 1e-9;     ///< residual relative to the loads
  int max_points = 500;
};

/// What a path passed between a point and the one before.
enum class PathEvent {
  none,
  limit_point,  ///< the load turned back: it has a maximum or minimum in between
  bifurcation,  ///< unstable directions appeared or vanished without a limit point
};

/// An equilibrium on the path to the full load.
struct PathPoint {
  double load_fraction = 0.0;  ///< fraction of loads and efforts, 0 at the start, 1 at full load
  int negative_pivots = 0;     ///< number of unstable directions
  PathEvent event = PathEvent::none;
};

/// Why a path ended.
enum class PathEnd {
  full_load,       ///< the last point lies at the full load or at most 10 % beyond it
  max_points,      ///< it has as many points as were asked for
  no_equilibrium,  ///< not even a very short step from the last point finds an equilibrium
};

/// A path of equilibria, maybe only to the point where it ended early.
struct Path {
  std::vector<PathPoint> points;
  PathEnd end = PathEnd::full_load;
  /// Fraction of the full load at the first maximum of the load: no neighbouring equilibrium exists
  /// above it. None if the load did not turn back.
  std::optional<double> limit_load;
  std::string reason;  ///< why it ended before the full load, with a remedy; else empty
};

/// "none", "limit-point", "bifurcation".
std::string_view path_event_name(PathEvent event);
/// "full-load", "max-points", "no-equilibrium".
std::string_view path_end_name(PathEnd end);

}  // namespace sinew::statics
