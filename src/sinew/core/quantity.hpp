/// @file
/// Physical quantities as text: "450 kPa", "10 ms", "1070 kg/m^3". Parsed values are in SI units.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew {

/// Dimension of a quantity: exponents of length, mass, time, temperature and current. A force is
/// {1, 1, -2}. Angles and ratios are dimensionless.
struct Dimension {
  int length = 0;
  int mass = 0;
  int time = 0;
  int temperature = 0;
  int current = 0;

  constexpr bool operator==(const Dimension&) const = default;
};

/// The dimensions that scenes use.
namespace dimension {
inline constexpr Dimension kNone{};                   ///< 1: ratios and angles
inline constexpr Dimension kLength{1, 0, 0};          ///< m
inline constexpr Dimension kArea{2, 0, 0};            ///< m^2
inline constexpr Dimension kVolume{3, 0, 0};          ///< m^3
inline constexpr Dimension kMass{0, 1, 0};            ///< kg
inline constexpr Dimension kTime{0, 0, 1};            ///< s
inline constexpr Dimension kFrequency{0, 0, -1};      ///< 1/s; also a rate and an angular velocity
inline constexpr Dimension kVelocity{1, 0, -1};       ///< m/s
inline constexpr Dimension kAcceleration{1, 0, -2};   ///< m/s^2
inline constexpr Dimension kForce{1, 1, -2};          ///< N
inline constexpr Dimension kPressure{-1, 1, -2};      ///< Pa; also a stress and Young's modulus
inline constexpr Dimension kEnergy{2, 1, -2};         ///< J; also a torque
inline constexpr Dimension kPower{2, 1, -3};          ///< W
inline constexpr Dimension kDensity{-3, 1, 0};        ///< kg/m^3
inline constexpr Dimension kStiffness{0, 1, -2};      ///< N/m
inline constexpr Dimension kDamping{0, 1, -1};        ///< N s/m
inline constexpr Dimension kViscosity{-1, 1, -1};     ///< Pa s
inline constexpr Dimension kVolumeRate{3, 0, -1};     ///< m^3/s
inline constexpr Dimension kPressureRate{-1, 1, -3};  ///< Pa/s
inline constexpr Dimension kConductance{4, -1, 1};    ///< m^3/(s Pa), of a valve
inline constexpr Dimension kTemperature{0, 0, 0, 1};  ///< K
inline constexpr Dimension kHeatCapacity{2, 1, -2, -1};    ///< J/K
inline constexpr Dimension kHeatLoss{2, 1, -3, -1};        ///< W/K
inline constexpr Dimension kCurrent{0, 0, 0, 0, 1};        ///< A
inline constexpr Dimension kResistance{2, 1, -3, 0, -2};   ///< Ohm
inline constexpr Dimension kCapacitance{-2, -1, 4, 0, 2};  ///< F
}  // namespace dimension

/// Name such as "a mass" or "a density"; without a name, "a quantity in kg^2 m".
std::string dimension_name(Dimension dimension);

/// Example of a quantity of this dimension, such as "42 g" or "1070 kg/m^3".
std::string dimension_example(Dimension dimension);

/// Parses one number with an optional unit, and returns its SI value. A number without unit is in
/// SI units. Numbers are read as in C, in any locale. A unit is a product of factors, joined by
/// `*`, blanks or `/`, each with an optional integer power: "kg/m^3", "N s/m", "kg m^-3", "1/s".
/// Factors are names with optional SI prefixes (m, g, s, N, Pa, J, W, Hz, l, L, bar, Nm, A, Ohm,
/// F), names without prefixes (K, psi, atm, in, min, h, deg, rad, dB, %), 1, and products in
/// parentheses. A blank between factors after a `/` ("N/m s") is an error, since it is ambiguous.
/// Throws Error at `place`: not-a-number, not-finite, out-of-range (too small for a double),
/// unknown-unit, wrong-dimension, wrong-length (several numbers).
double parse_quantity(std::string_view text, Dimension expected, const Location& place = {});

/// Parses three numbers followed by one unit: "0 0 -9.81 m/s^2". Numbers are separated by blanks or
/// commas. Throws like parse_quantity().
Vector3 parse_vector3(std::string_view text, Dimension expected, const Location& place = {});

/// Parses a list of numbers followed by one unit, like parse_vector3(): "-20 -20 0 20 20 20 mm".
/// There must be `count` numbers, or, if it is -1, at least one. Throws like parse_quantity().
std::vector<double> parse_list(std::string_view text, Dimension expected, int count,
                               const Location& place = {});

/// SI value of a unit, such as 0.001 for "mm". Throws like parse_quantity().
double parse_unit(std::string_view unit, Dimension expected, const Location& place = {});

/// Formats a value with a unit of suitable size: "450 kPa", "195 mm".
/// parse_quantity(format_quantity(v, d), d) == v, bit for bit, for every finite v. NaN and
/// infinities give "nan m" and "inf m", which parse_quantity() rejects.
std::string format_quantity(double value, Dimension dimension);

/// The same with four significant digits, for display: "8.887 ml".
std::string rounded_quantity(double value, Dimension dimension);

}  // namespace sinew
