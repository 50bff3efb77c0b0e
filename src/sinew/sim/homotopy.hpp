/// @file
/// Load stepping: removes an imbalance of forces in fractions.
#pragma once

#include <span>

#include "sinew/core/types.hpp"

namespace sinew::sim {

class Bodies;

/// The homotopy residual r_0 = b + H^T effort of a linearisation, and how much of it still acts:
/// the bodies' b is lessened by fraction * r_0, so that at 1 the robot is in equilibrium where it
/// stood, and at 0 where it belongs.
class Homotopy {
 public:
  /// @param bodies must outlive it.
  explicit Homotopy(Bodies& bodies) : bodies_(bodies) {}

  /// r_0 is that of the present linearisation. @param effort (rows,) N.
  void keep_residual(std::span<const double> effort);
  /// From the next linearisation on. @param fraction 0 to 1; 0 ends it.
  void set_fraction(double fraction);

 private:
  Bodies& bodies_;
  VectorX residual_, lessened_;  // (all bodies' size(),) N
};

}  // namespace sinew::sim
