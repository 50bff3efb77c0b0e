/// @file
/// The modulus of a bending actuator's silicone: a constant, or a polynomial of the pressure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sinew::pcc {

/// Kind of a modulus, and its relation to the shear modulus G of an incompressible material.
enum class ModulusKind {
  shear,    ///< G
  young,    ///< of uniaxial tension, E = 3 G
  bending,  ///< E in theta = M L/(E I), in plane strain (fibres keep lambda_2 = 1), E = 4 G
};

/// Behaviour of a polynomial at pressures outside its fitted range.
enum class OutsideRange {
  refuse,  ///< throws Error(out-of-range)
  hold,    ///< returns the value at the nearer end
};

/// "shear", "young", "bending". Throws Error(unknown-choice).
ModulusKind to_modulus_kind(std::string_view name);
std::string_view modulus_kind_name(ModulusKind kind);
/// "refuse", "hold". Throws Error(unknown-choice).
OutsideRange to_outside_range(std::string_view name);
std::string_view outside_range_name(OutsideRange outside);

/// The modulus as a function of pressure. Immutable.
class BendingModulus {
 public:
  /// Makes a constant modulus. Throws Error(not-finite | out-of-range).
  /// @param value Pa, > 0. @param kind of the modulus.
  explicit BendingModulus(double value, ModulusKind kind = ModulusKind::shear);
  /// Makes a polynomial sum_k coefficients[k] P^k, Pa for P in Pa. Throws Error(not-finite |
  /// empty-list | contradictory-limits), and Error(out-of-range) if it is not positive within its
  /// range.
  /// @param coefficients from the constant one on.
  /// @param kind of the modulus.
  /// @param lowest,highest range of pressures to which it was fitted, Pa.
  /// @param outside behaviour at other pressures.
  BendingModulus(std::vector<double> coefficients, ModulusKind kind, double lowest, double highest,
                 OutsideRange outside = OutsideRange::refuse);

  /// The published fit for a water-driven silicone actuator, E in theta = M L/(E I) at 10 to 110
  /// kPa: 1.795e-19 P^5 - 6.36e-14 P^4 + 8.535e-9 P^3 - 5.566e-4 P^2 + 15.97 P + 6.562e5.
  /// Below -20.7 kPa the polynomial is negative (docs/errata.md).
  /// @param outside behaviour at other pressures.
  static BendingModulus published(OutsideRange outside = OutsideRange::refuse);

  /// The modulus of its own kind, Pa. Throws Error(out-of-range) if it refuses the pressure.
  /// @param pressure Pa.
  double value(double pressure) const {
    return constant_ ? coefficients_[0] : polynomial(pressure);
  }
  /// The shear modulus G, Pa. Throws what value() throws. @param pressure Pa.
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
  double per_unit_ = 1.0;  // G / modulus
};

}  // namespace sinew::pcc
