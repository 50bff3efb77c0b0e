/// @file
/// A fluidic elastomer actuator as a quasi-static map from the volume of its fluid to the torque
/// that bends a segment.
#pragma once

namespace sinew::pcc {

/// tau(t) = a V(t - t_d) + c V(t - t_d)^3. The bending torque of a channel is odd in the volume, as
/// a push on one side is a pull on the other, and these are its first two terms; a vanishes where
/// the walls unfold before they stretch, and tau = c V^3 is left (Marchese, Tedrake & Rus, Int. J.
/// Robotics Research 35, 2016).
struct FluidicActuator {
  double linear = 0.0;  ///< a, N m/m^3, >= 0
  double cubic = 0.0;   ///< c, N m/m^9, >= 0; not both zero
  double delay = 0.0;   ///< t_d, s, >= 0, of the line

  /// Throws Error(out-of-range | not-finite).
  void check() const;
  /// N m of a volume V(t - t_d), m^3.
  double torque(double volume) const { return (linear + cubic * volume * volume) * volume; }
  /// d tau / dV, N m/m^3.
  double slope(double volume) const { return linear + 3.0 * cubic * volume * volume; }
  /// d2 tau / dV2, N m/m^6.
  double curvature(double volume) const { return 6.0 * cubic * volume; }
  /// The only volume, m^3, of a torque, N m: with a = 0 the cube root of tau/c, sign kept; else
  /// 2 sqrt(a/(3c)) sinh(asinh(3 tau/(2a) sqrt(3c/a))/3) (the hyperbolic solution of a depressed
  /// cubic).
  double volume(double torque) const;
};

}  // namespace sinew::pcc
