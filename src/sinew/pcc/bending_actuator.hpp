/// @file
/// A fibre-reinforced bending actuator with one angle: its closed-form dynamics.
///
/// An inextensible layer keeps the lower side of a pressurised silicone tube from stretching,
/// fibres keep its section, and so it bends into an arc of angle theta. Lagrange's equation of L =
/// I(theta) theta'^2/2 - V_s(theta, P) - V_g(theta) with the chamber's work P dV_c and Rayleigh's
/// dissipation is
///
///   I theta'' + I_theta theta'^2/2 + c theta' + dV_s/dtheta + dV_g/dtheta = P dV_c/dtheta.
///
/// The centre of the chamber stands r + r_t above the layer, so V_c = pi r^2 (L + (r + r_t) theta)
/// (Pappus) and P dV_c/dtheta = pi r^2 (r + r_t) P: the moment of the pressure on the end cap.
/// c = alpha I + beta 4 G int h^2 dA/L. The modulus may depend on P, which then changes V_s from
/// outside. docs/bending_actuator.md has the assumptions.
#pragma once

#include <Eigen/Core>

#include "sinew/pcc/bending_energies.hpp"
#include "sinew/pcc/bending_parameters.hpp"

namespace sinew::pcc {

/// J.
struct BendingEnergy {
  double strain = 0.0, gravity = 0.0, kinetic = 0.0;
  double total() const { return strain + gravity + kinetic; }
};

/// What a model of some order misses at most, at one pressure.
struct BendingError {
  double strain = 0.0;   ///< J
  double gravity = 0.0;  ///< J
  double inertia = 0.0;  ///< kg m^2
  double torque = 0.0;   ///< N m, of dV_s/dtheta + dV_g/dtheta
};

/// A model: immutable, shareable between threads; BendingMotion is its data. Evaluating allocates
/// nothing. Angles in rad, rates in rad/s, pressures in Pa above the surroundings.
/// Every function of a pressure throws Error(out-of-range) where the modulus refuses it, and
/// energy(), acceleration() and stiffness() for an angle that the model does not hold for.
class BendingActuator {
 public:
  /// Throws Error(not-finite | out-of-range) naming the parameter.
  explicit BendingActuator(const BendingParameters& parameters);

  const BendingParameters& parameters() const { return parameters_; }
  const BendingEnergies& energies() const { return energies_; }

  /// Of silicone and filling at rest, kg.
  double mass() const { return mass_; }
  /// Weight less buoyancy at rest, N; negative where it floats.
  double net_weight() const { return net_weight_; }
  /// int_wall h^2 dA about the layer, m^4.
  double second_moment() const { return second_moment_; }
  /// dV_c/dtheta = pi r^2 (r + r_t), m^3: moment over pressure.
  double moment_per_pressure() const { return moment_per_pressure_; }
  /// V_c, m^3.
  double chamber_volume(double theta) const;

  BendingEnergy energy(double theta, double rate, double pressure) const;
  /// theta'', rad/s^2.
  double acceleration(double theta, double rate, double pressure) const;
  /// d^2(V_s + V_g)/dtheta^2, N m/rad.
  double stiffness(double theta, double pressure) const;
  /// Energies with their derivatives. @param theta rad. Throws Error(out-of-range).
  BendingTerms terms(double theta) const;
  /// c, N m s/rad. @param inertia kg m^2. @param shear G, Pa.
  double damping(double inertia, double shear) const {
    return parameters_.mass_damping * inertia + viscosity_ * shear;
  }

  /// A stable angle at rest by Newton's method.
  /// @param pressure Pa. @param start rad, from where. Throws Error(not-converged) when there is
  /// none within a full turn, or only an unstable one.
  double equilibrium(double pressure, double start = 0.0) const;
  /// theta = M L/(E I), rad: the beam of small angles without weight.
  double linear_angle(double pressure) const;

  /// A point of the layer in the plane of bending, m from the base.
  /// @param theta rad. @param fraction of the arc length, 0 to 1; the tip is 1.
  /// Returns x aside and z up; at the inclination 0 and theta = 0 the tip is (0, -L).
  Eigen::Vector2d point(double theta, double fraction = 1.0) const;

  /// Bounds of what the Taylor polynomials leave out; zeros for an exact model.
  /// @param lowest,highest rad. @param pressure for the modulus.
  /// Throws Error(contradictory-limits | out-of-range) for angles that cross or leave the model's.
  BendingError taylor_error(double lowest, double highest, double pressure) const;

 private:
  BendingParameters parameters_;
  BendingEnergies energies_;
  double mass_, net_weight_, second_moment_, moment_per_pressure_, viscosity_;
};

}  // namespace sinew::pcc
