/// @file
/// The motion of a robot that has mass and no velocity, into an equilibrium.
#pragma once

#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/sim/state.hpp"

namespace sinew::sim {

struct Run;
class Stability;
class StaticSearch;

/// Implicit Euler steps of M dq/dt = r(q), of length tau, each solved by Newton:
///   sigma M (q - q_start) = r(q),   sigma (1/s^2) the inverse of tau times a unit of time;
/// sigma falls while the steps are easily solved, so that they end as Newton's own:
/// pseudo-transient continuation (Kelley & Keyes, SIAM J. Numer. Anal. 35 (1998) 508).
class OverdampedMotion {
 public:
  enum class End { arrived, returned, failed };

  /// @param search outlives it.
  explicit OverdampedMotion(StaticSearch& search);
  /// From the present state, along the motion that Newton would begin with. Whether it arrived.
  bool relax_from_here();
  /// Away from an unstable equilibrium, along the direction of its lowest curvature.
  /// @param stability of it. @param disturbance of the robot's size.
  End leave(const Stability& stability, double disturbance);

 private:
  End relax(double sigma, double near);
  bool arrives();
  double mass_along(const VectorX& direction);
  std::vector<Points> positions() const;
  double moved_since(const std::vector<Points>& before) const;

  StaticSearch& search_;
  Run& run_;
  State sound_;               // before the last step
  std::vector<Points> left_;  // of each body: positions of the unstable equilibrium that was left
};

}  // namespace sinew::sim
