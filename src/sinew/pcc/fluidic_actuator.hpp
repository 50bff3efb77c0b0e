/// @file
/// A fluidic elastomer actuator: a quasi-static map from the volume of its fluid to the bending
/// torque on a segment.
#pragma once

namespace sinew::pcc {

/// The torque tau(t) = a V(t - t_d) + c V(t - t_d)^3. The bending torque of a channel is an odd
/// function of the volume, since a push on one side is a pull on the other, and these are its first
/// two terms. If the walls unfold before they stretch, a vanishes and tau = c V^3 (Marchese,
/// Tedrake & Rus, Int. J. Robotics Research 35, 2016).
struct FluidicActuator {
  double linear = 0.0;  ///< a, N m/m^3, >= 0
  double cubic = 0.0;   ///< c, N m/m^9, >= 0; not both zero
  double delay = 0.0;   ///< t_d, s, >= 0, of the fluid line

  /// Checks the parameters. Throws Error(out-of-range | not-finite).
  void check() const;
  /// Torque, N m. @param volume V(t - t_d), m^3.
  double torque(double volume) const { return (linear + cubic * volume * volume) * volume; }
  /// Slope d tau / dV, N m/m^3.
  double slope(double volume) const { return linear + 3.0 * cubic * volume * volume; }
  /// Second derivative d2 tau / dV2, N m/m^6.
  double curvature(double volume) const { return 6.0 * cubic * volume; }
  /// The unique volume at a torque, m^3. For a = 0 it is the real cube root of tau/c, else
  /// 2 sqrt(a/(3c)) sinh(asinh(3 tau/(2a) sqrt(3c/a))/3), the hyperbolic solution of a depressed
  /// cubic. @param torque N m.
  double volume(double torque) const;
};

}  // namespace sinew::pcc
