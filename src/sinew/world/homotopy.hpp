/// @file
/// Load stepping: removal of a residual in fractions.
#pragma once

#include <span>

#include "sinew/core/types.hpp"

namespace sinew::world {

class Bodies;

/// The homotopy residual r_0 = b + H^T effort of a linearisation, and the fraction of it that still
/// acts: fraction * r_0 is subtracted from the bodies' b. At 1, the initial state is in
/// equilibrium; at 0, the full residual acts.
class Homotopy {
 public:
  /// @param bodies must outlive it.
  explicit Homotopy(Bodies& bodies) : bodies_(bodies) {}

  /// Stores r_0 of the present linearisation. @param effort (rows,) N.
  void keep_residual(std::span<const double> effort);
  /// Applies a fraction from the next linearisation on. @param fraction 0 to 1; 0 ends it.
  void set_fraction(double fraction);

 private:
  Bodies& bodies_;
  VectorX residual_, lessened_;  // (all bodies' size(),) N
};

}  // namespace sinew::world
