/// @file
/// Closed-form dynamics of a fibre-reinforced bending actuator with one angle.
///
/// An inextensible layer keeps the lower side of a pressurised silicone tube from stretching, and
/// fibres keep its section. The tube therefore bends into an arc of angle theta. With the
/// Lagrangian L = I(theta) theta'^2/2 - V_s(theta, P) - V_g(theta), the work P dV_c of the chamber
/// and Rayleigh damping, the equation of motion is
///
///   I theta'' + I_theta theta'^2/2 + c theta' + dV_s/dtheta + dV_g/dtheta = P dV_c/dtheta.
///
/// The centre of the chamber is r + r_t above the layer. Hence V_c = pi r^2 (L + (r + r_t) theta)
/// (Pappus), and P dV_c/dtheta = pi r^2 (r + r_t) P is the moment of the pressure on the end cap.
/// The damping is c = alpha I + beta 4 G int h^2 dA/L. If the modulus depends on P, V_s does too.
/// docs/bending_actuator.md states the assumptions.
#pragma once

#include <Eigen/Core>

#include "sinew/pcc/bending_energies.hpp"
#include "sinew/pcc/bending_parameters.hpp"

namespace sinew::pcc {

/// Energies of an actuator, J.
struct BendingEnergy {
  double strain = 0.0, gravity = 0.0, kinetic = 0.0;
  double total() const { return strain + gravity + kinetic; }
};

/// Error bounds of a Taylor model at one pressure.
struct BendingError {
  double strain = 0.0;   ///< J
  double gravity = 0.0;  ///< J
  double inertia = 0.0;  ///< kg m^2
  double torque = 0.0;   ///< N m, of dV_s/dtheta + dV_g/dtheta
};

/// The model of a bending actuator; BendingMotion has the state of a run. Immutable; threads may
/// share it. Evaluation does not allocate. Angles are in rad, rates in rad/s and pressures in Pa
/// relative to the surroundings. Every function of a pressure throws Error(out-of-range) if the
/// modulus refuses that pressure; energy(), acceleration() and stiffness() also throw it for an
/// angle outside the range of the model.
class BendingActuator {
 public:
  /// Throws Error(not-finite | out-of-range) that names the parameter.
  explicit BendingActuator(const BendingParameters& parameters);

  const BendingParameters& parameters() const { return parameters_; }
  const BendingEnergies& energies() const { return energies_; }

  /// Mass of silicone and filling at rest, kg.
  double mass() const { return mass_; }
  /// Weight minus buoyancy at rest, N; negative if the actuator floats.
  double net_weight() const { return net_weight_; }
  /// Second moment of area of the wall about the layer, int_wall h^2 dA, m^4.
  double second_moment() const { return second_moment_; }
  /// Moment per pressure, dV_c/dtheta = pi r^2 (r + r_t), m^3.
  double moment_per_pressure() const { return moment_per_pressure_; }
  /// Volume V_c of the chamber, m^3.
  double chamber_volume(double theta) const;

  BendingEnergy energy(double theta, double rate, double pressure) const;
  /// Angular acceleration theta'', rad/s^2.
  double acceleration(double theta, double rate, double pressure) const;
  /// Stiffness d^2(V_s + V_g)/dtheta^2, N m/rad.
  double stiffness(double theta, double pressure) const;
  /// Energies and inertia with their derivatives. Throws Error(out-of-range). @param theta rad.
  BendingTerms terms(double theta) const;
  /// Damping c, N m s/rad. @param inertia kg m^2. @param shear G, Pa.
  double damping(double inertia, double shear) const {
    return parameters_.mass_damping * inertia + viscosity_ * shear;
  }

  /// Finds a stable equilibrium angle by Newton's method. Throws Error(not-converged) if it finds
  /// none within the range of the model. @param pressure Pa. @param start initial guess, rad.
  double equilibrium(double pressure, double start = 0.0) const;
  /// Angle theta = M L/(E I) of the linear beam without weight, rad.
  double linear_angle(double pressure) const;

  /// Position of a point of the layer relative to the base, m, in the plane of bending: x sideways
  /// and z up. At inclination 0 and theta = 0, the tip is at (0, -L).
  /// @param theta rad. @param fraction of the arc length, 0 to 1; the tip is 1.
  Eigen::Vector2d point(double theta, double fraction = 1.0) const;

  /// Bounds of the remainder of the Taylor polynomials; zeros for an exact model. Throws
  /// Error(contradictory-limits) for lowest > highest, Error(out-of-range) for angles outside the
  /// range of the model. @param lowest,highest rad. @param pressure Pa, for the modulus.
  BendingError taylor_error(double lowest, double highest, double pressure) const;

 private:
  BendingParameters parameters_;
  BendingEnergies energies_;
  double mass_, net_weight_, second_moment_, moment_per_pressure_, viscosity_;
};

}  // namespace sinew::pcc
