#include "sinew/core/quantity.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "sinew/core/text.hpp"
#include "sinew/core/types.hpp"
#include "sinew/core/unit.hpp"

namespace sinew {

namespace {

/// Name, example and units of a dimension. `units` go from large to small.
struct DimensionWords {
  Dimension dimension;
  std::string_view name;
  std::string_view example;
  std::array<std::string_view, 5> units;
  int natural;  ///< position of the unit that is used for 0
};

constexpr std::array kWords = {
    DimensionWords{dimension::kNone, "a number without unit", "0.45", {""}, 0},
    DimensionWords{dimension::kLength, "a length", "195 mm", {"km", "m", "mm", "um", "nm"}, 1},
    DimensionWords{dimension::kArea, "an area", "20 mm^2", {"m^2", "mm^2", "um^2"}, 0},
    DimensionWords{dimension::kVolume, "a volume", "30 ml", {"m^3", "l", "ml", "mm^3"}, 0},
    DimensionWords{dimension::kMass, "a mass", "42 g", {"kg", "g", "mg", "ug"}, 0},
    DimensionWords{dimension::kTime, "a time", "10 ms", {"s", "ms", "us", "ns"}, 0},
    DimensionWords{dimension::kFrequency, "a rate or frequency", "0.1 1/s", {"1/s"}, 0},
    DimensionWords{dimension::kVelocity, "a velocity", "100 mm/s", {"m/s", "mm/s", "um/s"}, 0},
    DimensionWords{dimension::kAcceleration, "an acceleration", "9.81 m/s^2", {"m/s^2"}, 0},
    DimensionWords{dimension::kForce, "a force", "20 N", {"kN", "N", "mN", "uN"}, 1},
    DimensionWords{
        dimension::kPressure, "a pressure", "450 kPa", {"GPa", "MPa", "kPa", "Pa", "mPa"}, 3},
    DimensionWords{dimension::kEnergy, "an energy or torque", "1.5 J", {"kJ", "J", "mJ", "uJ"}, 1},
    DimensionWords{dimension::kPower, "a power", "5 W", {"kW", "W", "mW", "uW"}, 1},
    DimensionWords{dimension::kDensity, "a density", "1070 kg/m^3", {"kg/m^3"}, 0},
    DimensionWords{dimension::kStiffness, "a stiffness", "200 N/m", {"kN/m", "N/m", "mN/m"}, 1},
    DimensionWords{dimension::kDamping, "a damping", "0.5 N s/m", {"N s/m"}, 0},
    DimensionWords{dimension::kViscosity, "a viscosity", "10 Pa s", {"Pa s", "mPa s"}, 0},
    DimensionWords{
        dimension::kVolumeRate, "a volume rate", "5 ml/s", {"m^3/s", "l/s", "ml/s", "mm^3/s"}, 0},
    DimensionWords{
        dimension::kConductance, "a conductance of a valve", "2e-9 m^3/(s Pa)", {"m^3/(s Pa)"}, 0},
    DimensionWords{dimension::kTemperature, "a temperature", "293.15 K", {"K"}, 0},
    DimensionWords{dimension::kHeatCapacity, "a heat capacity", "0.1 J/K", {"J/K", "mJ/K"}, 0},
    DimensionWords{dimension::kHeatLoss, "a heat loss", "0.01 W/K", {"W/K", "mW/K"}, 0},
    DimensionWords{dimension::kCurrent, "a current", "0.5 A", {"A", "mA", "uA"}, 0},
    DimensionWords{
        dimension::kResistance, "a resistance", "1 kOhm", {"MOhm", "kOhm", "Ohm", "mOhm"}, 2},
    DimensionWords{dimension::kCapacitance, "a capacitance", "10 pF", {"F", "uF", "nF", "pF"}, 3},
    DimensionWords{
        dimension::kPressureRate, "a pressure rate", "20 kPa/s", {"MPa/s", "kPa/s", "Pa/s"}, 2},
};

const DimensionWords* find_words(Dimension dimension) {
  for (const DimensionWords& words : kWords) {
    if (words.dimension == dimension) return &words;
  }
  return nullptr;
}

/// Reads numbers; the rest of the text is the unit. One instance reads one text.
class NumberReader {
 public:
  NumberReader(std::string_view text, Dimension expected, const Location& place)
      : whole_(trimmed(text)), rest_(whole_), expected_(expected), place_(place) {}

  std::vector<double> numbers() {
    std::vector<double> values;
    while (starts_number(!values.empty())) {
      values.push_back(number());
      const std::size_t before = rest_.size();
      rest_ = trimmed(rest_);
      const bool blank = rest_.size() < before;
      if (rest_.starts_with(',')) {
        rest_ = trimmed(rest_.substr(1));
        if (!starts_number(false))
          fail(fmt::format("a number is missing behind a comma in '{}'", whole_));
      } else if (!blank) {
        break;
      }
    }
    if (values.empty()) fail(fmt::format("'{}' does not start with a number", whole_));
    return values;
  }

  std::string_view unit() const { return rest_; }

 private:
  /// A 1 before a slash and after a number belongs to the unit, as in "0.1 1/s".
  bool starts_number(bool unit_may_follow) const {
    if (rest_.empty()) return false;
    std::string_view text = rest_;
    if (unit_may_follow && text.front() == '1' && trimmed(text.substr(1)).starts_with('/')) {
      return false;
    }
    if (text.front() == '+' || text.front() == '-') text.remove_prefix(1);
    if (text.starts_with('.')) text.remove_prefix(1);
    if (!text.empty() && is_digit(text.front())) return true;
    return names_non_finite(text);
  }

  static bool names_non_finite(std::string_view text) {
    for (const std::string_view word : {"nan", "inf", "infinity", ".nan", ".inf"}) {
      const bool longer = text.size() > word.size() && !is_blank(text[word.size()]);
      if (!longer && edit_distance(text.substr(0, word.size()), word) == 0) return true;
    }
    return false;
  }

  double number() {
    std::string_view text = rest_;
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const auto length = static_cast<std::size_t>(end - text.data());
    const std::string_view token = text.substr(0, length);
    if (error == std::errc::result_out_of_range) fail_range(token);
    if (error != std::errc{} && !names_non_finite(text)) {
      fail(fmt::format("'{}' is not a number", text.substr(0, text.find(' '))));
    }
    if (error != std::errc{} || !std::isfinite(value)) {
      throw Error(
          ErrorKind::not_finite, place_, fmt::format("'{}' is not finite", whole_),
          fmt::format("write a finite number, for example '{}'", dimension_example(expected_)));
    }
    rest_ = text.substr(length);
    return value;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::not_a_number, place_, message,
                fmt::format("write {}, for example '{}'", dimension_name(expected_),
                            dimension_example(expected_)));
  }

  [[noreturn]] void fail_range(std::string_view token) const {
    const bool tiny = token.find("e-") != std::string_view::npos ||
                      token.find("E-") != std::string_view::npos || token.starts_with("0.0") ||
                      token.starts_with("-0.0");
    throw Error(tiny ? ErrorKind::out_of_range : ErrorKind::not_finite, place_,
                fmt::format("'{}' is too {} for a double", token, tiny ? "small" : "large"),
                tiny ? "write 0 if it is to be nothing" : "write a smaller number");
  }

  std::string_view whole_;
  std::string_view rest_;
  Dimension expected_;
  const Location& place_;
};

[[noreturn]] void fail_dimension(std::string_view text, std::string_view numbers, const Unit& unit,
                                 Dimension expected, const Location& place) {
  const DimensionWords* words = find_words(expected);
  const std::string_view symbol =
      words ? words->example.substr(std::min(words->example.find(' '), words->example.size()))
            : std::string_view{};
  const std::string example = words ? fmt::format("{}{}", numbers, symbol)
                                    : fmt::format("{} {}", numbers, si_unit_name(expected));
  throw Error(ErrorKind::wrong_dimension, place,
              fmt::format("expected {}, got '{}' ({})", dimension_name(expected), text,
                          dimension_name(unit.dimension)),
              fmt::format("write for example '{}'", example));
}

[[noreturn]] void fail_length(std::string_view text, std::size_t found, int count,
                              const Location& place) {
  throw Error(
      ErrorKind::wrong_length, place,
      fmt::format("expected {} number{}, got {} in '{}'", count, count == 1 ? "" : "s", found,
                  text),
      fmt::format("write {} number{} and then the unit, if any", count, count == 1 ? "" : "s"));
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string("nan");
}

/// Formats `value` in a unit, if some number near the quotient reads back as exactly `value`.
bool format_in(double value, std::string_view symbol, std::string* text) {
  const Unit unit = parse_unit_expression(symbol, {});
  const double quotient = value / unit.numerator * unit.denominator;
  const std::array candidates = {quotient, std::nextafter(quotient, kInfinity),
                                 std::nextafter(quotient, -kInfinity)};
  std::string best;
  for (const double candidate : candidates) {
    if (!std::isfinite(candidate) || unit.to_si(candidate) != value) continue;
    const std::string digits = shortest(candidate);
    if (best.empty() || digits.size() < best.size()) best = digits;
  }
  if (best.empty()) return false;
  *text = symbol.empty() ? best : best + ' ' + std::string(symbol);
  return true;
}

/// The largest unit in which the value is at least 1, else the smallest unit.
std::string_view fitting_unit(double value, const DimensionWords& words) {
  std::string_view chosen = words.units[static_cast<std::size_t>(words.natural)];
  if (value == 0.0 || !std::isfinite(value)) return chosen;
  for (const std::string_view symbol : words.units) {
    if (symbol.empty()) break;
    chosen = symbol;
    const Unit unit = parse_unit_expression(symbol, {});
    if (std::abs(value) >= unit.to_si(1.0)) break;
  }
  return chosen;
}

}  // namespace

std::string dimension_name(Dimension dimension) {
  const DimensionWords* words = find_words(dimension);
  if (words) return std::string(words->name);
  return "a quantity in " + si_unit_name(dimension);
}

std::string dimension_example(Dimension dimension) {
  const DimensionWords* words = find_words(dimension);
  return words ? std::string(words->example) : "1 " + si_unit_name(dimension);
}

std::vector<double> parse_list(std::string_view text, Dimension expected, int count,
                               const Location& place) {
  NumberReader reader(text, expected, place);
  std::vector<double> values = reader.numbers();
  const std::string_view whole = trimmed(text);
  const Unit unit = parse_unit_expression(reader.unit(), place, expected);
  if (count >= 0 && values.size() != static_cast<std::size_t>(count)) {
    fail_length(whole, values.size(), count, place);
  }
  if (!reader.unit().empty() && unit.dimension != expected) {
    const std::size_t length = whole.size() - reader.unit().size();
    fail_dimension(whole, trimmed(whole.substr(0, length)), unit, expected, place);
  }
  for (double& value : values) {
    value = unit.to_si(value);
    if (std::isfinite(value)) continue;
    throw Error(ErrorKind::not_finite, place, fmt::format("'{}' is too large for a double", whole),
                "write a smaller number");
  }
  return values;
}

double parse_quantity(std::string_view text, Dimension expected, const Location& place) {
  return parse_list(text, expected, 1, place).front();
}

Vector3 parse_vector3(std::string_view text, Dimension expected, const Location& place) {
  const std::vector<double> values = parse_list(text, expected, 3, place);
  return {values[0], values[1], values[2]};
}

double parse_unit(std::string_view unit, Dimension expected, const Location& place) {
  const Unit parsed = parse_unit_expression(trimmed(unit), place);
  if (parsed.dimension != expected) fail_dimension(unit, "1", parsed, expected, place);
  return parsed.to_si(1.0);
}

std::string format_quantity(double value, Dimension dimension) {
  const DimensionWords* words = find_words(dimension);
  std::string text;
  if (words && std::isfinite(value) && format_in(value, fitting_unit(value, *words), &text)) {
    return text;
  }
  if (dimension == Dimension{}) return shortest(value);
  return shortest(value) + ' ' + si_unit_name(dimension);
}

std::string rounded_quantity(double value, Dimension dimension) {
  const DimensionWords* words = find_words(dimension);
  const std::string symbol =
      words ? std::string(fitting_unit(value, *words)) : si_unit_name(dimension);
  const std::string number =
      fmt::format("{:.4g}", value / parse_unit_expression(symbol, {}).to_si(1.0));
  return symbol.empty() ? number : number + ' ' + symbol;
}

}  // namespace sinew
