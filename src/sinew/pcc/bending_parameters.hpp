/// @file
/// Parameters of a fibre-reinforced bending actuator, and the properties of its section.
#pragma once

#include <optional>

#include "sinew/pcc/bending_modulus.hpp"

namespace sinew::pcc {

/// Where the mass of a section is located.
enum class MassLine {
  layer,    ///< on the inextensible layer, as published
  section,  ///< distributed over the section, at its height above the layer
};

/// A round silicone tube whose lowest fibre is inextensible and whose winding keeps the width of
/// sections. The section is a disc of radius r_o that touches the layer, minus the chamber, a disc
/// of radius r whose nearest point is r_t above the layer.
struct BendingParameters {
  double length = 0.1;           ///< L, m, > 0, of the layer
  double chamber_radius = 6e-3;  ///< r, m, > 0
  double wall_thickness = 2e-3;  ///< r_t, m, > 0, between chamber and layer
  std::optional<double>
      outer_radius;  ///< r_o, m, >= r + r_t; none: r + r_t, a wall of one thickness

  BendingModulus modulus{0.2e6};
  double silicone_density = 1070.0;   ///< kg/m^3, > 0
  double filling_density = 1.2;       ///< kg/m^3, >= 0: 1.2 air, 1000 water
  double surroundings_density = 1.2;  ///< kg/m^3, >= 0

  /// Inclination of the base, rad: the actuator hangs at 0, is level and bends upwards at pi/2, and
  /// stands at pi.
  double inclination = 0.0;
  double gravity = 9.81;  ///< m/s^2, >= 0

  double mass_damping = 0.0;       ///< Rayleigh's alpha, 1/s, >= 0
  double stiffness_damping = 0.0;  ///< Rayleigh's beta, s, >= 0, for the stiffness at theta = 0

  std::optional<int> order = 5;  ///< of the Taylor model, 2 to kMaxOrder; none: exact
  MassLine mass_line = MassLine::layer;

  double outer() const { return outer_radius.value_or(chamber_radius + wall_thickness); }
  /// Height of the chamber's centre above the layer, r + r_t, m.
  double chamber_height() const { return chamber_radius + wall_thickness; }
};

inline constexpr int kMaxOrder = 20;

/// Checks parameters. Throws Error(not-finite | out-of-range) that names the parameter and its
/// value.
void check(const BendingParameters& parameters);

/// An integral over a section, and its first and second moments of height above the layer.
struct SectionSum {
  double total = 0.0, first = 0.0, second = 0.0;
};

/// Mass per length of the section with its moments, kg/m, kg, kg m.
SectionSum mass_sum(const BendingParameters& parameters);
/// Mass per length minus that of the displaced fluid, kg/m, kg, kg m. The densities are
/// rho_s - rho_w for the wall and rho_f - rho_w for the chamber, so that a chamber filled with the
/// surrounding fluid leaves (rho_s - rho_w) V_e.
SectionSum net_mass_sum(const BendingParameters& parameters);

}  // namespace sinew::pcc
