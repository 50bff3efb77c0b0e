#include "sinew/core/usual_range.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/unit.hpp"

namespace sinew {

namespace {

// Foams have some kPa, and so have the smallest pressures that move a chamber. Metals have up to
// 1e12 Pa and 22,600 kg/m^3 (osmium), aerogels 50 kg/m^3. Robots of more than 20 kg are rare.
constexpr std::array kRanges = {
    UsualRange{dimension::kPressure, 1e3, 1e12, "a pressure or modulus", "kPa", "Pa"},
    UsualRange{dimension::kDensity, 50.0, 25e3, "a density", "g/cm^3", "kg/m^3"},
    UsualRange{dimension::kStiffness, 1.0, 1e8, "a stiffness", "N/mm", "N/m"},
    UsualRange{dimension::kMass, 1e-9, 20.0, "a mass", "kg", "g"}};

}  // namespace

const UsualRange* usual_range(Dimension dimension) {
  for (const UsualRange& range : kRanges) {
    if (range.dimension == dimension) return &range;
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
