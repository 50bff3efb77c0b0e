/// @file
/// What a fibre-reinforced bending actuator is made of, and what follows from it for its section.
#pragma once

#include <optional>

#include "sinew/pcc/bending_modulus.hpp"

namespace sinew::pcc {

/// Where the mass of a section sits.
enum class MassLine {
  layer,    ///< on the inextensible layer, as published
  section,  ///< where the section has it, at its height above the layer
};

/// A round silicone tube whose lowest fibre cannot stretch, wound so that sections keep their
/// width. The section: a disc of radius r_o that touches the layer, less the chamber, a disc of
/// radius r whose nearest point is the wall r_t above the layer.
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

  /// rad, of the base: 0 hangs, pi/2 is level and bends upwards, pi stands.
  double inclination = 0.0;
  double gravity = 9.81;  ///< m/s^2, >= 0

  double mass_damping = 0.0;       ///< Rayleigh's alpha, 1/s, >= 0
  double stiffness_damping = 0.0;  ///< Rayleigh's beta, s, >= 0, on the unbent stiffness

  std::optional<int> order = 5;  ///< of the energies in theta, 2 to kMaxOrder; none: exact
  MassLine mass_line = MassLine::layer;

  double outer() const { return outer_radius.value_or(chamber_radius + wall_thickness); }
  /// Height of the chamber's centre above the layer, r + r_t, m.
  double chamber_height() const { return chamber_radius + wall_thickness; }
};

inline constexpr int kMaxOrder = 20;

/// Throws Error(not-finite | out-of-range) naming the parameter and its value.
void check(const BendingParameters& parameters);

/// Sums over a section, a metre of length, and their first and second moments of height above the
/// layer.
struct SectionSum {
  double total = 0.0, first = 0.0, second = 0.0;
};

/// kg/m, kg, kg m.
SectionSum mass_sum(const BendingParameters& parameters);
/// Weight less buoyancy over gravity, kg/m, kg, kg m: of the wall rho_s - rho_w, of the chamber
/// rho_f - rho_w, so that a chamber full of what is around leaves (rho_s - rho_w) V_e.
SectionSum net_mass_sum(const BendingParameters& parameters);

}  // namespace sinew::pcc
