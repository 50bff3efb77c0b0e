/// @file
/// What a path of equilibria passes between two of its points.
#pragma once

#include "sinew/statics/path_settings.hpp"

namespace sinew::statics {

/// An equilibrium on a path, with the slope of the load along it.
struct PathPlace {
  double load_fraction = 0.0;
  int negative_pivots = 0;
  double slope = 0.0;  ///< d(load fraction)/ds, 1/m, s the length of the motion of all coordinates
  bool rubs = false;   ///< whether contacts with friction touch
  bool touches = false;  ///< whether any contact touches
};

/// Two successive points of a path. Along a smooth path r(q, s) = 0 with the tangent A, det A has
/// the sign of the slope of the load, times a sign that changes only at a bifurcation (Allgower &
/// Georg, Numerical Continuation Methods, 1990, 2.1 and 8.1): where the load turns back at a simple
/// limit point, one unstable direction appears or vanishes, and between limit points none. The
/// corners of frictionless contacts obey the same rule, since the orientation of a piecewise linear
/// path does not change (Eaves, SIAM Rev. 18 (1976) 1). Any other change is a bifurcation. With
/// friction, directions are also released where points begin to slip.
struct PathChange {
  PathPlace from, to;
  double length = 0.0;  ///< m, of the motion in between

  bool turns() const { return from.slope * to.slope < 0.0; }
  bool bifurcates() const;
  PathEvent event() const;
  /// Whether the load at the bifurcation is known: the points' loads differ by less than 1 %.
  bool is_narrow() const;
  /// The largest load fraction in between, of a path that turns back; by a cubic with the slopes at
  /// its ends, except in contact, where the path may have a corner.
  double peak() const;
};

}  // namespace sinew::statics
