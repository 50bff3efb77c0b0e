/// @file
/// Physical quantities as text: "450 kPa", "10 ms", "1070 kg/m^3". Values are SI inside.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew {

/// Exponents of length, mass, time, temperature and current: a force is {1, 1, -2}. Angles and
/// ratios have no dimension.
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

/// "a mass", "a density"; dimensions without a name as "a quantity in kg^2 m".
std::string dimension_name(Dimension dimension);

/// A quantity of this dimension as one would write it: "42 g", "1070 kg/m^3".
std::string dimension_example(Dimension dimension);

/// One number and its unit, in SI. A bare number is SI. The number is read as in C, whatever the
/// locale. A unit is a product of factors: names with SI prefixes (m, g, s, N, Pa, J, W, K, Hz, l,
/// L, bar, Nm, A, Ohm, F), names without (psi, atm, in, min, h, deg, rad, dB, %), parentheses and
/// 1, joined by
/// `*`, blanks or `/`, each with an integer power: "kg/m^3", "N s/m", "kg m^-3", "1/s".
/// A blank after a `/` ("N/m s") is refused, since it is read in two ways.
/// Throws Error at `place`: not-a-number, not-finite, unknown-unit, wrong-dimension, wrong-length
/// (several numbers).
double parse_quantity(std::string_view text, Dimension expected, const Location& place = {});

/// Three numbers with one unit behind: "0 0 -9.81 m/s^2". Blanks or commas stand between numbers.
/// Throws as parse_quantity.
Vector3 parse_vector3(std::string_view text, Dimension expected, const Location& place = {});

/// `count` numbers with one unit behind, as in parse_vector3: "-20 -20 0 20 20 20 mm".
/// `count` says how many numbers there must be; -1 stands for any number of them, at least one.
/// Throws as parse_quantity.
std::vector<double> parse_list(std::string_view text, Dimension expected, int count,
                               const Location& place = {});

/// The SI value of one of the unit, such as 0.001 for "mm". Throws as parse_quantity.
double parse_unit(std::string_view unit, Dimension expected, const Location& place = {});

/// The value with a unit whose prefix keeps the number short: "450 kPa", "195 mm".
/// parse_quantity(format_quantity(v, d), d) == v, bit for bit, for every finite v. NaN and
/// infinities are written "nan m" and "inf m", which parse_quantity refuses.
std::string format_quantity(double value, Dimension dimension);

/// The same in four significant digits, to be read by people: "8.887 ml".
std::string rounded_quantity(double value, Dimension dimension);

}  // namespace sinew
