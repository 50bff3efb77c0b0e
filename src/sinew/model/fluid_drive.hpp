/// @file
/// Drives of chambers filled with gas or liquid, directly or through valves.
#pragma once

#include <optional>

#include "sinew/law/drive.hpp"

namespace sinew::model {

using law::CommandKind;
using law::Drive;
using law::QuantityName;

/// A regulator that supplies the commanded pressure through a valve, and a leak from the chamber to
/// ambient. Gas: flow rate by ISO 6358-1:2013, as a volume at ambient pressure and temperature,
///   q = C p1 for p2/p1 <= b, q = C p1 sqrt(1 - ((p2/p1 - b)/(1 - b))^2) above,
/// with absolute pressures, p1 upstream; above p2/p1 = 0.999 it is linear to zero, so the flow has
/// a derivative. Liquid: q = C (p1 - p2).
struct Supply {
  double conductance = 0.0;     ///< C of the valve, m^3/(s Pa), > 0
  double critical_ratio = 0.5;  ///< b, in [0, 1); gas only
  double leak = 0.0;            ///< C of the leak to ambient, >= 0

  /// @param visitor of the chamber. @param gas whether it supplies gas.
  void describe(PartVisitor& visitor, bool gas) const {
    visitor.number("supply.conductance", "m^3/(s Pa)", conductance).add(critical_ratio);
    if (gas) visitor.list("supply.critical_ratio", "", critical_ratio);
    visitor.number("supply.leak", "m^3/(s Pa)", leak);
  }
};

/// p_abs = p_ambient (v / V)^k, where v is the chamber's content as a volume at ambient pressure
/// and V the chamber's volume, including the dead volume: isothermal for k = 1, adiabatic for k =
/// 1.4 (diatomic gas).
struct GasSettings {
  double ambient_pressure = 101325.0;  ///< Pa, absolute, > 0
  double exponent = 1.0;               ///< k, >= 1
  double dead_volume = 0.0;            ///< m^3 of tubes and fittings, >= 0
  std::optional<Supply> supply;        ///< none: the commanded pressure acts without delay
};

/// Drive of a chamber filled with gas. Effort: pressure above ambient. State: v (m^3). Input: gas
/// added to the content at rest at ambient pressure (m^3 at ambient pressure).
class GasDrive : public Drive {
 public:
  static constexpr QuantityName kInput{"gas", "m^3"};

  /// @param settings of the gas.
  /// @param rest_volume of the chamber, m^3.
  /// Throws Error(out-of-range); Error(zero-volume) if rest_volume + dead_volume is not positive.
  GasDrive(const GasSettings& settings, double rest_volume);

  int state_size() const override { return 1; }
  void rest(std::span<double> state) const override;
  QuantityName input() const override { return kInput; }
  bool acts_on(CommandKind kind) const override;
  bool controllable() const override { return true; }
  Response respond(const Step& step, double motion) const override;
  void advance(const Step& step, double motion, double effort,
               std::span<double> state) const override;
  void describe(PartVisitor& visitor) const override;

 private:
  double volume(double motion) const;
  Response fed(const Step& step, double volume) const;

  GasSettings settings_;
  double rest_volume_;  // m^3, including the dead volume
};

/// p = K (v - V)/V_0, where v is the volume of the liquid at zero pressure. Cavitation is not
/// modelled: the pressure may be negative.
struct LiquidSettings {
  double bulk_modulus = 2.2e9;   ///< K, Pa, > 0 (water at 20 degrees Celsius)
  double density = 0.0;          ///< kg/m^3, >= 0, for its weight; inertia is neglected
  double dead_volume = 0.0;      ///< m^3, >= 0
  std::optional<Supply> supply;  ///< critical_ratio is not used
};

/// Drive of a chamber filled with liquid. Effort: pressure. State: v - V_0 (m^3). Input: liquid
/// added (m^3).
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
  void describe(PartVisitor& visitor) const override;

 private:
  LiquidSettings settings_;
  double stiffness_;  // K / V_0, Pa/m^3
};

}  // namespace sinew::model
