/// @file
/// From an equilibrium to a stable one.
#pragma once

#include <string>

#include "sinew/sim/overdamped_motion.hpp"

namespace sinew::sim {

struct Run;
class StaticSearch;

/// Moves a robot from an equilibrium with negative pivots (Stability) to one without: overdamped
/// motion starts in the direction of the lowest curvature. If there is a potential, this motion
/// descends it and ends in another equilibrium. If the motion returns, the equilibrium is stable
/// after all, which is possible only without a potential.
class Settling {
 public:
  /// Both must outlive it. The search's report receives stability and counts.
  Settling(StaticSearch& search, OverdampedMotion& motion);

  /// Each solution replaces surfaces by their tangent planes: repeats it with updated planes until
  /// the plane of no touching point changes. Throws Error(not-converged).
  void follow_surfaces();
  /// Moves from the present equilibrium to a stable one, unless the settings accept any.
  /// Throws Error(not-converged), and what require_held() throws if the tangent is singular.
  void settle();
  /// Throws Error(singular-matrix) if the present equilibrium is neutral: it has a free motion that
  /// moves a body, and not only turns it about its centre of mass.
  void require_held();

 private:
  bool returns(const VectorX& motion);

  Run& run_;
  StaticSearch& search_;
  OverdampedMotion& motion_;
};

/// Throws Error(singular-matrix) that names the free motion of the present state, if there is one,
/// with `message` before it; returns if there is none.
void fail_if_free(StaticSearch& search, const std::string& message);

}  // namespace sinew::sim
