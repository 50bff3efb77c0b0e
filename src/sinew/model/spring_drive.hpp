/// @file
/// Drives of springs along cables: linear springs and shape-memory springs.
#pragma once

#include "sinew/law/drive.hpp"

namespace sinew::model {

using law::CommandKind;
using law::Drive;
using law::QuantityName;

/// Stiffness (N/m) of a close-coiled helical spring, G d^4 / (8 n D^3) (Wahl, Mechanical Springs,
/// 2nd ed., 1963, eq. 5-7), from the torsion of the wire only.
/// @param shear_modulus Pa. @param wire,mean_diameter m. @param coils number of active coils.
double coil_stiffness(double shear_modulus, double wire, double mean_diameter, double coils);

/// Tension T = k (L - L_free) + c dL/dt.
struct SpringSettings {
  double stiffness = 0.0;     ///< k, N/m, > 0
  double free_length = 0.0;   ///< m, >= 0
  double damping = 0.0;       ///< c, N s/m, >= 0
  bool tension_only = false;  ///< whether it goes slack instead of pushing, like a band
};

/// Drive of a linear spring. Effort: tension (N), negative when it pushes. Motion: L_rest - L (m).
/// No input.
class SpringDrive : public Drive {
 public:
  /// @param settings of the spring. @param rest_length of the row's cable, m.
  /// Throws Error(out-of-range).
  SpringDrive(const SpringSettings& settings, double rest_length);

  int state_size() const override { return 0; }
  void rest(std::span<double>) const override {}
  QuantityName input() const override { return {}; }
  bool acts_on(CommandKind) const override { return true; }
  bool controllable() const override { return false; }
  Response respond(const Step& step, double motion) const override;
  void advance(const Step&, double, double, std::span<double>) const override {}
  void describe(PartVisitor& visitor) const override {
    visitor.number("stiffness", "N/m", settings_.stiffness)
        .number("free_length", "m", settings_.free_length)
        .number("damping", "N s/m", settings_.damping)
        .add(settings_.tension_only, rest_length_);
  }

 private:
  SpringSettings settings_;
  double rest_length_;
};

/// A helical spring of shape-memory wire. Its stiffness follows the shear modulus
///   G = G_M + x (G_A - G_M).
/// The austenite fraction x follows from the temperature by the cosine law of Liang & Rogers (J.
/// Intell. Mater. Syst. Struct. 1, 1990), without the shift of the transformation temperatures by
/// stress:
///   heating x = (1 - cos(pi (T - A_s)/(A_f - A_s)))/2,
///   cooling x = (1 - cos(pi (T - M_f)/(M_s - M_f)))/2,
/// where x never decreases on heating nor increases on cooling. Temperature: C dT/dt = P - H (T -
/// T_a) with the electric power P, by backward Euler. Tension T = k (L - L_free) with one L_free
/// for both phases: the residual twist of the cold wire is not modelled.
struct SmaSettings {
  double wire = 0.0005, mean_diameter = 0.0024;             ///< m
  double coils = 10.0;                                      ///< number of active coils
  double martensite_modulus = 14.1e9;                       ///< G_M, Pa
  double austenite_modulus = 24.7e9;                        ///< G_A, Pa
  double free_length = 0.0;                                 ///< m
  double damping = 0.0;                                     ///< N s/m
  double heat_capacity = 0.1;                               ///< C, J/K
  double heat_loss = 0.01;                                  ///< H, W/K
  double ambient = 293.15;                                  ///< T_a, K
  double austenite_start = 341.0, austenite_end = 351.0;    ///< A_s, A_f, K
  double martensite_start = 325.0, martensite_end = 315.0;  ///< M_s, M_f, K
  bool by_phase = false;  ///< whether the input is x itself, else the power
};

/// Drive of a shape-memory spring. Effort and motion as for SpringDrive. Input: electric power (W)
/// or austenite fraction (0 to 1). State: temperature (K) and x.
class SmaDrive : public Drive {
 public:
  static constexpr QuantityName kPower{"power", "W"}, kPhase{"phase", ""};

  /// @param settings of the spring. @param rest_length of the row's cable, m.
  /// Throws Error(out-of-range).
  SmaDrive(const SmaSettings& settings, double rest_length);

  int state_size() const override { return 2; }
  void rest(std::span<double> state) const override;
  QuantityName input() const override { return settings_.by_phase ? kPhase : kPower; }
  bool acts_on(CommandKind) const override { return true; }
  bool controllable() const override { return false; }
  Response respond(const Step& step, double motion) const override;
  void advance(const Step& step, double motion, double effort,
               std::span<double> state) const override;
  void describe(PartVisitor& visitor) const override;

 private:
  struct Wire {
    double temperature, phase;
  };
  Wire wire_after(const Step& step) const;

  SmaSettings settings_;
  double rest_length_;
};

}  // namespace sinew::model
