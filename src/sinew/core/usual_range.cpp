#include "sinew/core/usual_range.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/unit.hpp"

namespace sinew {

namespace {

// Foams have some kPa, and so have the smallest pressures that move a chamber. Metals have up to
// 1e12 Pa and 22,600 kg/m^3 (osmium), aerogels 50 kg/m^3. Robots of more than 20 kg are rare. The
// weight of a thread of 1 mm is 0.01 N/m, and a shear of 1 Pa still moves a soft film. The energy
// of softening is that of a silicone at a strain of a few per cent or more.
constexpr std::array kRanges = {
    UsualRange{Usual::pressure, dimension::kPressure, 1e3, 1e12, "a pressure", "kPa", "Pa"},
    UsualRange{Usual::modulus, dimension::kPressure, 1e3, 1e12, "a modulus", "kPa", "Pa"},
    UsualRange{Usual::force_per_area, dimension::kPressure, 1.0, 1e9, "a force per area", "kPa",
               "Pa"},
    UsualRange{Usual::energy_per_volume, dimension::kPressure, 1.0, 1e9, "an energy per volume",
               "kPa", "Pa"},
    UsualRange{Usual::density, dimension::kDensity, 50.0, 25e3, "a density", "g/cm^3", "kg/m^3"},
    UsualRange{Usual::stiffness, dimension::kStiffness, 1.0, 1e8, "a stiffness", "N/mm", "N/m"},
    UsualRange{Usual::force_per_length, dimension::kStiffness, 1e-3, 1e6, "a force per length",
               "N/mm", "N/m"},
    UsualRange{Usual::mass, dimension::kMass, 1e-9, 20.0, "a mass", "kg", "g"}};

}  // namespace

const UsualRange* usual_range(Usual usual) {
  for (const UsualRange& range : kRanges) {
    if (range.usual == usual) return &range;
  }
  return nullptr;
}

bool is_unusual(const UsualRange& range, double value) {
  const double size = std::abs(value);
  return size > 0.0 && (size < range.least || size > range.most);
}

Notice unusual_notice(const UsualRange& range, double value, const std::string& written,
                      const Location& place) {
  const bool small = std::abs(value) < range.least;
  const std::string number = written.empty() ? fmt::format("{:g}", value) : written;
  return {
      NoticeLevel::warning, NoticeKind::suspicious_unit, place,
      fmt::format("{} without a unit is {}, which is {} for {}", number,
                  rounded_quantity(std::abs(value), range.dimension), small ? "little" : "much",
                  range.name),
      fmt::format("write its unit, such as {} {}, or {} if it is meant", number,
                  small ? range.smaller : range.larger, rounded_quantity(value, range.dimension))};
}

}  // namespace sinew
