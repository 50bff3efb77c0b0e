/// @file
/// Chambers filled with gas or liquid, fed at once or through valves.
#pragma once

#include <optional>

#include "sinew/step/drive.hpp"

namespace sinew::sim {

using step::CommandKind;
using step::Drive;
using step::QuantityName;

/// A regulator that holds the commanded pressure before a valve, and what leaks out of the chamber.
/// Gas: flow by ISO 6358-1:2013, in volume at ambient pressure and temperature,
///   q = C p1 for p2/p1 <= b, q = C p1 sqrt(1 - ((p2/p1 - b)/(1 - b))^2) above,
/// absolute pressures, 1 upstream; beyond p2/p1 = 0.999 linear to zero, so that the flow has a
/// derivative. Liquid: q = C (p1 - p2).
struct Supply {
  double conductance = 0.0;     ///< C of the valve, m^3/(s Pa), > 0
  double critical_ratio = 0.5;  ///< b, in [0, 1); gas only
  double leak = 0.0;            ///< C of the way out to ambient, >= 0

  void add_to(ValueHash& hash) const { hash.add(conductance, critical_ratio, leak); }
};

/// p_abs = p_ambient (v / V)^k with v the chamber's content in volume at ambient pressure and V its
/// volume with the dead one: isothermal for k = 1, adiabatic for k = 1.4 (diatomic gas).
struct GasSettings {
  double ambient_pressure = 101325.0;  ///< Pa, absolute, > 0
  double exponent = 1.0;               ///< k, >= 1
  double dead_volume = 0.0;            ///< m^3 of tubes and fittings, >= 0
  std::optional<Supply> supply;        ///< none: the commanded pressure acts at once
};

/// Effort: pressure above ambient. State: v (m^3). Input: gas added to what the chamber holds at
/// rest at ambient pressure (m^3 at ambient pressure).
class GasDrive : public Drive {
 public:
  static constexpr QuantityName kInput{"gas", "m^3"};

  /// @param settings see there.
  /// @param rest_volume of the chamber, m^3.
  /// Throws Error(out-of-range); zero-volume when rest_volume + dead_volume is not positive.
  GasDrive(const GasSettings& settings, double rest_volume);

  int state_size() const override { return 1; }
  void rest(std::span<double> state) const override;
  QuantityName input() const override { return kInput; }
  bool acts_on(CommandKind kind) const override;
  bool controllable() const override { return true; }
  Response respond(const Step& step, double motion) const override;
  void advance(const Step& step, double motion, double effort,
               std::span<double> state) const override;
  void add_to(ValueHash& hash) const override {
    hash.add(settings_.ambient_pressure, settings_.exponent, settings_.supply, rest_volume_);
  }

 private:
  double volume(double motion) const;
  Response fed(const Step& step, double volume) const;

  GasSettings settings_;
  double rest_volume_;  // with the dead one
};

/// p = K (v - V)/V_0 with v the liquid that was filled in, at no pressure; cavitation is not
/// modelled: a chamber may suck.
struct LiquidSettings {
  double bulk_modulus = 2.2e9;   ///< K, Pa, > 0 (water at 20 degrees Celsius)
  double density = 0.0;          ///< kg/m^3, >= 0: its weight, not its inertia, is felt
  double dead_volume = 0.0;      ///< m^3, >= 0
  std::optional<Supply> supply;  ///< critical_ratio is not used
};

/// Effort: pressure. State: v - V_0 (m^3). Input: liquid added (m^3).
class LiquidDrive : public Drive {
 public:
  static constexpr QuantityName kInput{"liquid", "m^3"};

  /// @param settings,rest_volume as for GasDrive.
  LiquidDrive(const LiquidSettings& settings, double rest_volume);

  int state_size() const override { return 1; }
  void rest(std::span<double> state) const override { state[0] = 0.0; }
  QuantityName input() const override { return kInput; }
  bool acts_on(CommandKind kind) const override;
  bool controllable() const override { return true; }
  Response respond(const Step& step, double motion) const override;
  void advance(const Step& step, double motion, double effort,
               std::span<double> state) const override;
  void add_to(ValueHash& hash) const override {
    hash.add(settings_.density, settings_.supply, stiffness_);
  }

 private:
  LiquidSettings settings_;
  double stiffness_;  // K / V_0, Pa/m^3
};

}  // namespace sinew::sim
