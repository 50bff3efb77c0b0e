/// @file
/// The modulus of a bending actuator's silicone: a constant, or a polynomial of the pressure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sinew::pcc {

/// Which modulus a number or a fit stands for, and what it makes of the shear modulus G of an
/// incompressible material.
enum class ModulusKind {
  shear,    ///< G
  young,    ///< of uniaxial tension, E = 3 G
  bending,  ///< E in theta = M L/(E I): fibres keep lambda_2 = 1, plane strain, E = 4 G
};

/// What a polynomial does at pressures that it was not fitted to.
enum class OutsideRange {
  refuse,  ///< Error(out-of-range)
  hold,    ///< the value at the nearer end
};

/// "shear", "young", "bending". Throws Error(unknown-choice).
ModulusKind to_modulus_kind(std::string_view name);
std::string_view modulus_kind_name(ModulusKind kind);
/// "refuse", "hold". Throws Error(unknown-choice).
OutsideRange to_outside_range(std::string_view name);
std::string_view outside_range_name(OutsideRange outside);

/// Immutable.
class BendingModulus {
 public:
  /// @param value Pa, > 0, at every pressure. @param kind what it is.
  /// Throws Error(not-finite | out-of-range).
  explicit BendingModulus(double value, ModulusKind kind = ModulusKind::shear);
  /// sum_k coefficients[k] P^k, Pa for P in Pa.
  /// @param coefficients from the constant one on.
  /// @param kind of which modulus.
  /// @param lowest,highest pressures that it was fitted to, Pa.
  /// @param outside what to do at others.
  /// Throws Error(not-finite | empty-list | contradictory-limits), and Error(out-of-range) where
  /// it is not positive within its range.
  BendingModulus(std::vector<double> coefficients, ModulusKind kind, double lowest, double highest,
                 OutsideRange outside = OutsideRange::refuse);

  /// The published fit of a water-driven silicone actuator, E of theta = M L/(E I) at 10 to 110
  /// kPa: 1.795e-19 P^5 - 6.36e-14 P^4 + 8.535e-9 P^3 - 5.566e-4 P^2 + 15.97 P + 6.562e5.
  /// Below -20.7 kPa the polynomial is negative (docs/errata.md).
  /// @param outside what to do at other pressures.
  static BendingModulus published(OutsideRange outside = OutsideRange::refuse);

  /// Of its own kind, Pa. @param pressure Pa. Throws Error(out-of-range) as it was told to.
  double value(double pressure) const {
    return constant_ ? coefficients_[0] : polynomial(pressure);
  }
  /// G, Pa. @param pressure Pa. Throws as value().
  double shear(double pressure) const { return per_unit_ * value(pressure); }

  ModulusKind kind() const { return kind_; }
  bool is_constant() const { return constant_; }
  const std::vector<double>& coefficients() const { return coefficients_; }
  double lowest_pressure() const { return lowest_; }    ///< Pa; -infinity for a constant
  double highest_pressure() const { return highest_; }  ///< Pa; infinity for a constant
  OutsideRange outside() const { return outside_; }

 private:
  double polynomial(double pressure) const;

  std::vector<double> coefficients_;
  ModulusKind kind_;
  OutsideRange outside_ = OutsideRange::refuse;
  bool constant_ = false;
  double lowest_, highest_;
  double per_unit_ = 1.0;  // G of a modulus of one
};

}  // namespace sinew::pcc
