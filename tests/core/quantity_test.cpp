#include "sinew/core/quantity.hpp"

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sinew {
namespace {

using ::testing::HasSubstr;

struct Good {
  const char* text;
  Dimension dimension;
  double value;
};

class GoodQuantities : public ::testing::TestWithParam<Good> {};

TEST_P(GoodQuantities, AreReadExactly) {
  const Good& each = GetParam();
  EXPECT_EQ(parse_quantity(each.text, each.dimension), each.value) << each.text;
}

INSTANTIATE_TEST_SUITE_P(
    Table, GoodQuantities,
    ::testing::Values(
        Good{"450 kPa", dimension::kPressure, 450e3}, Good{"10 ms", dimension::kTime, 0.01},
        Good{"42 g", dimension::kMass, 0.042}, Good{"1070 kg/m^3", dimension::kDensity, 1070.0},
        Good{"0.1 1/s", dimension::kFrequency, 0.1}, Good{"5/s", dimension::kFrequency, 5.0},
        Good{"1/s", dimension::kFrequency, 1.0}, Good{"2 Hz", dimension::kFrequency, 2.0},
        Good{"9.81 m/s^2", dimension::kAcceleration, 9.81},
        Good{"1.1 mm", dimension::kLength, 1.1e-3}, Good{"0.3 um", dimension::kLength, 0.3e-6},
        Good{"0.3 µm", dimension::kLength, 0.3e-6}, Good{"1e1mm", dimension::kLength, 0.01},
        Good{"+3 m", dimension::kLength, 3.0}, Good{"-.5 m", dimension::kLength, -0.5},
        Good{"  7  ", dimension::kMass, 7.0}, Good{"1 in", dimension::kLength, 0.0254},
        Good{"2 min", dimension::kTime, 120.0}, Good{"1 h", dimension::kTime, 3600.0},
        Good{"3 ml", dimension::kVolume, 3e-6},
        Good{"3 l/min", dimension::kVolumeRate, 3.0 / 60000.0},
        Good{"1 bar", dimension::kPressure, 1e5}, Good{"15 mbar", dimension::kPressure, 1500.0},
        Good{"1 atm", dimension::kPressure, 101325.0}, Good{"50 %", dimension::kNone, 0.5},
        Good{"180 deg", dimension::kNone, std::numbers::pi},
        Good{"90°", dimension::kNone, std::numbers::pi / 2}, Good{"1 rad", dimension::kNone, 1.0},
        Good{"3 N*s/m", dimension::kDamping, 3.0}, Good{"3 N s/m", dimension::kDamping, 3.0},
        Good{"3 N·s/m", dimension::kDamping, 3.0}, Good{"2 kg m^-3", dimension::kDensity, 2.0},
        Good{"2 kg/(m s^2)", dimension::kPressure, 2.0},
        Good{"2 N/mm^2", dimension::kPressure, 2e6}, Good{"2 N/mm²", dimension::kPressure, 2e6},
        Good{"4 mm**3", dimension::kVolume, 4e-9}, Good{"4 mNm", dimension::kEnergy, 4e-3},
        Good{"4 mN m", dimension::kEnergy, 4e-3}, Good{"1 g/cm^3", dimension::kDensity, 1000.0},
        Good{"1 hPa", dimension::kPressure, 100.0}, Good{"2 kJ", dimension::kEnergy, 2000.0},
        Good{"2 mW", dimension::kPower, 2e-3}));

TEST(Quantity, PoundPerSquareInchFollowsItsDefinition) {
  // NIST SP 811 (2008), appendix B.8: 6.894757e3 Pa.
  EXPECT_NEAR(parse_quantity("1 psi", dimension::kPressure), 6894.757293168361, 1e-11);
}

struct BadQuantity {
  const char* text;
  Dimension dimension;
  ErrorKind kind;
  const char* says;
};

class BadQuantities : public ::testing::TestWithParam<BadQuantity> {};

TEST_P(BadQuantities, NamePlaceValueAndRemedy) {
  const BadQuantity& each = GetParam();
  const Location place{.file = "trunk.yaml", .line = 3, .column = 7, .item = "bodies.trunk.mass"};
  try {
    parse_quantity(each.text, each.dimension, place);
    FAIL() << "accepted '" << each.text << "'";
  } catch (const Error& error) {
    EXPECT_EQ(error_kind_name(error.kind()), error_kind_name(each.kind)) << error.what();
    EXPECT_THAT(error.what(), HasSubstr(each.says));
    EXPECT_THAT(error.what(), HasSubstr("trunk.yaml:3:7: bodies.trunk.mass"));
    EXPECT_FALSE(error.remedy().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadQuantities,
    ::testing::Values(
        BadQuantity{"", dimension::kMass, ErrorKind::not_a_number, "42 g"},
        BadQuantity{"heavy", dimension::kMass, ErrorKind::not_a_number, "heavy"},
        BadQuantity{"g", dimension::kMass, ErrorKind::not_a_number, "'g'"},
        BadQuantity{"-", dimension::kMass, ErrorKind::not_a_number, "'-'"},
        BadQuantity{"1, g", dimension::kMass, ErrorKind::not_a_number, "comma"},
        BadQuantity{"42 m", dimension::kMass, ErrorKind::wrong_dimension,
                    "expected a mass, got '42 m' (a length); write for example '42 g'"},
        BadQuantity{"10 %", dimension::kMass, ErrorKind::wrong_dimension, "without unit"},
        BadQuantity{"1 kg/m^2", dimension::kMass, ErrorKind::wrong_dimension, "kg m^-2"},
        BadQuantity{"42 gramm", dimension::kMass, ErrorKind::unknown_unit, "gramm"},
        BadQuantity{"4 kpa", dimension::kPressure, ErrorKind::unknown_unit, "did you mean 'kPa'?"},
        BadQuantity{"4 kpaa", dimension::kForce, ErrorKind::unknown_unit, "write one of N, mN, kN"},
        BadQuantity{"4 m3", dimension::kVolume, ErrorKind::unknown_unit, "m^3"},
        BadQuantity{"4 m^", dimension::kVolume, ErrorKind::unknown_unit, "power"},
        BadQuantity{"4 m^99", dimension::kVolume, ErrorKind::unknown_unit, "power"},
        BadQuantity{"4 m^1.5", dimension::kVolume, ErrorKind::unknown_unit, ".5"},
        BadQuantity{"4 N/m s", dimension::kDamping, ErrorKind::unknown_unit, "two ways"},
        BadQuantity{"4 N/", dimension::kDamping, ErrorKind::unknown_unit, "missing"},
        BadQuantity{"4 N//m", dimension::kDamping, ErrorKind::unknown_unit, "missing"},
        BadQuantity{"4 (N/m", dimension::kStiffness, ErrorKind::unknown_unit, "')'"},
        BadQuantity{"4 N/m)", dimension::kStiffness, ErrorKind::unknown_unit, ")"},
        BadQuantity{"4 ((((((((((((((((m))))))))))))))))", dimension::kLength,
                    ErrorKind::unknown_unit, "parentheses"},
        BadQuantity{"42 g 3", dimension::kMass, ErrorKind::unknown_unit, "'3'"},
        BadQuantity{"0x10 m", dimension::kLength, ErrorKind::unknown_unit, "x10"},
        BadQuantity{"1 2 m", dimension::kLength, ErrorKind::wrong_length, "got 2"},
        BadQuantity{"1,5 mm", dimension::kLength, ErrorKind::wrong_length, "1,5"},
        BadQuantity{"nan kg", dimension::kMass, ErrorKind::not_finite, "nan"},
        BadQuantity{"-inf kg", dimension::kMass, ErrorKind::not_finite, "inf"},
        BadQuantity{".inf", dimension::kMass, ErrorKind::not_finite, "inf"},
        BadQuantity{"NaN", dimension::kMass, ErrorKind::not_finite, "NaN"},
        BadQuantity{"1e999 kg", dimension::kMass, ErrorKind::not_finite, "large"},
        BadQuantity{"1e308 km", dimension::kLength, ErrorKind::not_finite, "large"},
        BadQuantity{"1e-999 kg", dimension::kMass, ErrorKind::out_of_range, "small"}));

TEST(Quantity, ReadsVectorsAndLists) {
  EXPECT_EQ(parse_vector3("0 0 0 m/s^2", dimension::kAcceleration), Vector3(0, 0, 0));
  EXPECT_EQ(parse_vector3("1, -2,3 mm", dimension::kLength), Vector3(1e-3, -2e-3, 3e-3));
  EXPECT_EQ(parse_vector3("1 2 3 1/s", dimension::kFrequency), Vector3(1, 2, 3));
  EXPECT_EQ(parse_vector3("1 1 1 1/s", dimension::kFrequency), Vector3(1, 1, 1));
  EXPECT_EQ(parse_list("-20 -20 0 20 20 20 mm", dimension::kLength, 6),
            (std::vector<double>{-0.02, -0.02, 0, 0.02, 0.02, 0.02}));
  EXPECT_EQ(parse_list("1 2", dimension::kLength, -1), (std::vector<double>{1, 2}));
  const auto wrong = [](const char* text) {
    try {
      parse_vector3(text, dimension::kLength);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(wrong("1 2 mm"), ErrorKind::wrong_length);
  EXPECT_EQ(wrong("1 2 3 4 mm"), ErrorKind::wrong_length);
  EXPECT_EQ(wrong("1 2 3 s"), ErrorKind::wrong_dimension);
  EXPECT_EQ(wrong("1 2 nan mm"), ErrorKind::not_finite);
}

TEST(Quantity, ReadsUnitsAlone) {
  EXPECT_EQ(parse_unit("mm", dimension::kLength), 1e-3);
  EXPECT_THROW(parse_unit("kg", dimension::kLength), Error);
  EXPECT_THROW(parse_unit("furlong", dimension::kLength), Error);
}

TEST(Quantity, IgnoresTheLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) std::setlocale(LC_ALL, name);
  EXPECT_EQ(parse_quantity("1.5 mm", dimension::kLength), 1.5e-3);
  EXPECT_EQ(format_quantity(1.5e-3, dimension::kLength), "1.5 mm");
  std::setlocale(LC_ALL, before.c_str());
}

TEST(Quantity, WritesSensiblePrefixes) {
  EXPECT_EQ(format_quantity(450e3, dimension::kPressure), "450 kPa");
  EXPECT_EQ(format_quantity(0.195, dimension::kLength), "195 mm");
  EXPECT_EQ(format_quantity(0.042, dimension::kMass), "42 g");
  EXPECT_EQ(format_quantity(0.01, dimension::kTime), "10 ms");
  EXPECT_EQ(format_quantity(-20.0, dimension::kForce), "-20 N");
  EXPECT_EQ(format_quantity(0.0, dimension::kForce), "0 N");
  EXPECT_EQ(format_quantity(0.0, dimension::kLength), "0 m");
  EXPECT_EQ(format_quantity(1070.0, dimension::kDensity), "1070 kg/m^3");
  EXPECT_EQ(format_quantity(0.45, dimension::kNone), "0.45");
  EXPECT_EQ(format_quantity(3e-6, dimension::kVolume), "3 ml");
  EXPECT_EQ(format_quantity(2.0, Dimension{-1, 2, 3}), "2 kg^2 m^-1 s^3");
}

TEST(Quantity, RoundsForPeople) {
  EXPECT_EQ(rounded_quantity(8.887499999999994e-6, dimension::kVolume), "8.887 ml");
  EXPECT_EQ(rounded_quantity(3.500163179565854e-7, dimension::kVolume), "350 mm^3");
  EXPECT_EQ(rounded_quantity(0.1 + 0.2, dimension::kTime), "300 ms");
  EXPECT_EQ(rounded_quantity(-1234567.0, dimension::kPressure), "-1.235 MPa");
  EXPECT_EQ(rounded_quantity(0.0, dimension::kLength), "0 m");
  EXPECT_EQ(rounded_quantity(1.0 / 3.0, dimension::kNone), "0.3333");
  EXPECT_EQ(rounded_quantity(2.0 / 3.0, Dimension{-1, 2, 3}), "0.6667 kg^2 m^-1 s^3");
}

TEST(Quantity, RoundTripsEveryBit) {
  const Dimension all[] = {
      dimension::kNone,         dimension::kLength,    dimension::kArea,
      dimension::kVolume,       dimension::kMass,      dimension::kTime,
      dimension::kFrequency,    dimension::kVelocity,  dimension::kAcceleration,
      dimension::kForce,        dimension::kPressure,  dimension::kEnergy,
      dimension::kPower,        dimension::kDensity,   dimension::kStiffness,
      dimension::kDamping,      dimension::kViscosity, dimension::kVolumeRate,
      dimension::kPressureRate, Dimension{2, -3, 4}};
  std::uint64_t state = 1;
  const auto next = [&] { return state = state * 6364136223846793005ULL + 1442695040888963407ULL; };
  for (int trial = 0; trial < 20000; ++trial) {
    const Dimension dimension = all[trial % 20];
    double value = std::bit_cast<double>(next() ^ (next() >> 32));
    if (trial % 2 == 0) value = std::ldexp(static_cast<double>(next() >> 11), -30 - trial % 60);
    if (!std::isfinite(value)) continue;
    const std::string text = format_quantity(value, dimension);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(parse_quantity(text, dimension)),
              std::bit_cast<std::uint64_t>(value))
        << text;
  }
  EXPECT_TRUE(
      std::signbit(parse_quantity(format_quantity(-0.0, dimension::kMass), dimension::kMass)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(format_quantity(nan, dimension::kMass).substr(0, 3), "nan");
}

TEST(Quantity, ExamplesAreOfTheirDimension) {
  for (int l = -3; l <= 3; ++l) {
    for (int m = -1; m <= 1; ++m) {
      for (int t = -3; t <= 1; ++t) {
        const Dimension dimension{l, m, t};
        EXPECT_NO_THROW(parse_quantity(dimension_example(dimension), dimension));
        EXPECT_FALSE(dimension_name(dimension).empty());
      }
    }
  }
}

}  // namespace
}  // namespace sinew
