/// @file
/// Overdamped motion into an equilibrium.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/run/state.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::world {
class Stability;
}

namespace sinew::statics {

class StaticSearch;

/// Implicit Euler steps of the first-order equation M dq/dt = r(q), each solved by Newton's method:
///   sigma M (q - q_start) = r(q),   sigma (1/s^2) the inverse of the step length times 1 s.
/// sigma decreases while the steps are easy to solve, so they turn into Newton's method:
/// pseudo-transient continuation (Kelley & Keyes, SIAM J. Numer. Anal. 35 (1998) 508).
class OverdampedMotion {
 public:
  enum class End { arrived, returned, failed };

  /// @param search must outlive it.
  explicit OverdampedMotion(StaticSearch& search);
  /// Relaxes from the present state. @param first length of the first step along forces that no
  /// tangent resists, relative to the robot's size.
  /// @return whether it reached an equilibrium.
  bool relax_from_here(double first = kFirstMove);
  /// Solves slow steps from an equilibrium, which do not move it: where contacts and ropes hold a
  /// body by more forces than it needs, the law then chooses those of a body at rest, while those
  /// of the motion that led here may be at their limits. With enough inertia, the matrix is
  /// definite though the stiffness of the loads may not be.
  /// @return whether it is an equilibrium with these forces; if not, the state is what it was.
  bool stand();
  /// Leaves an unstable equilibrium along the direction of its lowest curvature.
  /// @param stability of the equilibrium. @param disturbance relative to the robot's size.
  End leave(const world::Stability& stability, double disturbance);

  /// Positions of the nodes of each body, and the largest change of any coordinate since, m.
  std::vector<Points> positions() const;
  double moved_since(const std::vector<Points>& before) const;

 private:
  End relax(double sigma, double near);
  bool arrives();
  static constexpr double kFirstMove = 0.02;
  double first_sigma(double first);
  double sigma_of_loads();
  bool turns_back(const std::vector<Points>& before, std::vector<Points>& last) const;

  StaticSearch& search_;
  run::Run& run_;
  run::State sound_;          // before the last step
  std::vector<Points> left_;  // positions of each body in the unstable equilibrium
};

}  // namespace sinew::statics
