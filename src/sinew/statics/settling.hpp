/// @file
/// From an equilibrium to a stable one.
#pragma once

#include <string>

#include "sinew/statics/overdamped_motion.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::statics {

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
  /// Moves from a state near an unstable equilibrium, at which a motion has come to a standstill,
  /// to an equilibrium. @return whether the tangent there is unstable and the motion arrived.
  bool leave_nearby();
  /// Judges the free motion of the present equilibrium of a loose robot, if it has one that moves a
  /// body and not only turns it about its centre of mass. The tangent does not contain the
  /// curvature of surfaces that touch, so the motion tells: a small displacement along it returns
  /// (a ball in a bowl), stays, or leaves (a ball on a ball), after which this looks for the next
  /// equilibrium. A neutral one of bodies that touch others is an equilibrium at any place, and
  /// stands where it is, as it would with the least friction.
  /// Throws Error(singular-matrix) in any other neutral equilibrium.
  void require_held();

 private:
  enum class Pushed { returns, stays, leaves, lost };
  Pushed push(const VectorX& motion);
  Pushed touch(const VectorX& motion);
  bool is_neutral();
  [[noreturn]] void fail_unstable();
  bool condense();
  bool leave_unheld();
  bool touches(std::size_t body) const;
  bool sticks() const;
  bool descends(const VectorX& motion);

  run::Run& run_;
  StaticSearch& search_;
  OverdampedMotion& motion_;
};

/// Throws Error(singular-matrix) that names the free motion of the present state, if there is one,
/// with `message` before it; returns if there is none.
void fail_if_free(StaticSearch& search, const std::string& message);

}  // namespace sinew::statics
