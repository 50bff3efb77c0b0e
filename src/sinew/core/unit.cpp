#include "sinew/core/unit.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sinew/core/text.hpp"

namespace sinew {

namespace {

struct NamedUnit {
  std::string_view name;
  Unit unit;
  bool prefixed;
};

struct Prefix {
  std::string_view name;
  double numerator;
  double denominator;
};

constexpr std::array kPrefixes = {
    Prefix{"p", 1.0, 1e12},  Prefix{"n", 1.0, 1e9}, Prefix{"u", 1.0, 1e6},   Prefix{"µ", 1.0, 1e6},
    Prefix{"μ", 1.0, 1e6},   Prefix{"m", 1.0, 1e3}, Prefix{"c", 1.0, 100.0}, Prefix{"d", 1.0, 10.0},
    Prefix{"h", 100.0, 1.0}, Prefix{"k", 1e3, 1.0}, Prefix{"M", 1e6, 1.0},   Prefix{"G", 1e9, 1.0},
    Prefix{"T", 1e12, 1.0}};

// The pound-force per square inch: 4.4482216152605 N (exact) over (0.0254 m)^2.
constexpr std::array kUnits = {
    NamedUnit{"m", {1.0, 1.0, dimension::kLength}, true},
    NamedUnit{"g", {1.0, 1e3, dimension::kMass}, true},
    NamedUnit{"s", {1.0, 1.0, dimension::kTime}, true},
    NamedUnit{"N", {1.0, 1.0, dimension::kForce}, true},
    NamedUnit{"Pa", {1.0, 1.0, dimension::kPressure}, true},
    NamedUnit{"J", {1.0, 1.0, dimension::kEnergy}, true},
    NamedUnit{"W", {1.0, 1.0, dimension::kPower}, true},
    NamedUnit{"K", {1.0, 1.0, dimension::kTemperature}, false},
    NamedUnit{"Hz", {1.0, 1.0, dimension::kFrequency}, true},
    NamedUnit{"Nm", {1.0, 1.0, dimension::kEnergy}, true},
    NamedUnit{"l", {1.0, 1e3, dimension::kVolume}, true},
    NamedUnit{"L", {1.0, 1e3, dimension::kVolume}, true},
    NamedUnit{"A", {1.0, 1.0, dimension::kCurrent}, true},
    NamedUnit{"V", {1.0, 1.0, {.length = 2, .mass = 1, .time = -3, .current = -1}}, true},
    NamedUnit{"Ohm", {1.0, 1.0, dimension::kResistance}, true},
    NamedUnit{"F", {1.0, 1.0, dimension::kCapacitance}, true},
    NamedUnit{"bar", {1e5, 1.0, dimension::kPressure}, true},
    NamedUnit{"psi", {4.4482216152605, 0.00064516, dimension::kPressure}, false},
    NamedUnit{"atm", {101325.0, 1.0, dimension::kPressure}, false},
    NamedUnit{"in", {254.0, 1e4, dimension::kLength}, false},
    NamedUnit{"min", {60.0, 1.0, dimension::kTime}, false},
    NamedUnit{"h", {3600.0, 1.0, dimension::kTime}, false},
    NamedUnit{"rad", {1.0, 1.0, dimension::kNone}, false},
    NamedUnit{"deg", {std::numbers::pi, 180.0, dimension::kNone}, false},
    NamedUnit{"°", {std::numbers::pi, 180.0, dimension::kNone}, false},
    NamedUnit{"dB", {1.0, 1.0, dimension::kNone}, false},
    NamedUnit{"%", {1.0, 100.0, dimension::kNone}, false},
    NamedUnit{"1", {1.0, 1.0, dimension::kNone}, false},
};

std::optional<Unit> find_unit(std::string_view name) {
  for (const NamedUnit& named : kUnits) {
    if (named.name == name) return named.unit;
  }
  for (const Prefix& prefix : kPrefixes) {
    if (!name.starts_with(prefix.name)) continue;
    for (const NamedUnit& named : kUnits) {
      if (!named.prefixed || named.name != name.substr(prefix.name.size())) continue;
      return Unit{prefix.numerator, prefix.denominator, dimension::kNone} * named.unit;
    }
  }
  return std::nullopt;
}

/// A remedy with the most likely intended name, from common units only, and only from those of the
/// expected dimension if there is one.
std::string suggest(std::string_view name, std::optional<Dimension> expected) {
  constexpr std::array<std::string_view, 34> kCommon = {
      "m",  "mm", "cm",  "um",   "km",  "kg",  "g",   "mg",  "s",   "ms", "us", "N",
      "mN", "kN", "Pa",  "kPa",  "MPa", "GPa", "J",   "mJ",  "W",   "K",  "Hz", "Nm",
      "l",  "ml", "bar", "mbar", "psi", "atm", "min", "deg", "rad", "in"};
  const std::size_t digits = name.find_first_of("0123456789");
  if (digits != std::string_view::npos && digits > 0 && find_unit(name.substr(0, digits))) {
    return fmt::format("write '{}^{}' for a power", name.substr(0, digits), name.substr(digits));
  }
  std::vector<std::string_view> candidates(kCommon.begin(), kCommon.end());
  if (expected) {
    std::erase_if(candidates,
                  [&](std::string_view unit) { return find_unit(unit)->dimension != *expected; });
  }
  const std::string nearest = nearest_word(name, candidates);
  if (nearest.empty() && !candidates.empty() && expected) {
    return fmt::format("write one of {}, or a product of units", fmt::join(candidates, ", "));
  }
  if (nearest.empty())
    return "known are m, g, s, N, Pa, J, W, K, Hz, l, bar, A, V, Ohm, F with SI prefixes, psi, "
           "atm, in, min, h, deg, rad, dB, % and their products";
  return fmt::format("did you mean '{}'?", nearest);
}

/// Reduces the fraction if one part is a multiple of the other. Otherwise kg would be 1000/1000,
/// and values would be rounded twice.
std::pair<double, double> reduced(double numerator, double denominator) {
  if (std::fmod(numerator, denominator) == 0.0) return {numerator / denominator, 1.0};
  if (std::fmod(denominator, numerator) == 0.0) return {1.0, denominator / numerator};
  return {numerator, denominator};
}

/// Recursive descent over product = factor { ('*' | '/' | blank) factor }.
class Parser {
 public:
  Parser(std::string_view text, const Location& place, std::optional<Dimension> expected)
      : text_(text), place_(place), expected_(expected) {}

  Unit whole() {
    skip_blanks();
    if (at_end()) return {};
    Unit unit = starts_with("/") ? Unit{} : factor();
    unit = rest_of_product(unit);
    if (!at_end()) fail(fmt::format("cannot read '{}' in the unit '{}'", rest(), text_));
    return unit;
  }

 private:
  static constexpr int kMaxDepth = 8;

  bool at_end() const { return position_ == text_.size(); }
  std::string_view rest() const { return text_.substr(position_); }
  bool starts_with(std::string_view token) const { return rest().starts_with(token); }
  bool take(std::string_view token) {
    if (!starts_with(token)) return false;
    position_ += token.size();
    return true;
  }
  bool skip_blanks() {
    const std::size_t start = position_;
    while (!at_end() && is_blank(text_[position_])) ++position_;
    return position_ > start;
  }

  [[noreturn]] void fail(const std::string& message, std::string remedy = {}) const {
    if (remedy.empty()) remedy = "write a product of units such as 'kg/m^3' or 'N s/m'";
    throw Error(ErrorKind::unknown_unit, place_, message, remedy);
  }

  Unit rest_of_product(Unit unit) {
    bool divided = false;
    while (true) {
      const bool blank = skip_blanks();
      if (at_end() || starts_with(")")) return unit;
      if (take("/")) {
        skip_blanks();
        unit = unit * inverse(factor());
        divided = true;
      } else if (take("*") || take("·")) {
        skip_blanks();
        unit = unit * factor();
      } else if (blank && divided) {
        fail(fmt::format("the unit '{}' can be read in two ways", text_),
             "put the denominator in parentheses, such as 'N/(m s)', or write 'N s/m'");
      } else if (blank) {
        unit = unit * factor();
      } else {
        return unit;
      }
    }
  }

  Unit factor() {
    Unit unit;
    if (take("(")) {
      if (++depth_ > kMaxDepth) fail("the unit has too many parentheses");
      skip_blanks();
      unit = rest_of_product(factor());
      --depth_;
      if (!take(")")) fail(fmt::format("a ')' is missing in the unit '{}'", text_));
    } else {
      unit = named();
    }
    return power(unit, exponent());
  }

  Unit named() {
    const std::size_t start = position_;
    while (!at_end() && !is_blank(text_[position_]) &&
           std::string_view("*/^()").find(text_[position_]) == std::string_view::npos &&
           !starts_with("·") && !starts_with("²") && !starts_with("³")) {
      ++position_;
    }
    const std::string_view name = text_.substr(start, position_ - start);
    if (name.empty()) fail(fmt::format("a unit's name is missing in '{}'", text_));
    const std::optional<Unit> unit = find_unit(name);
    if (!unit) {
      const bool alone = name == text_;
      fail(fmt::format("the unit '{}' is not known", name),
           suggest(name, alone ? expected_ : std::nullopt));
    }
    return *unit;
  }

  int exponent() {
    if (take("²")) return 2;
    if (take("³")) return 3;
    if (!take("^") && !take("**")) return 1;
    int value = 0;
    const char* begin = text_.data() + position_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc{} || value < -9 || value > 9) {
      fail(fmt::format("the power in the unit '{}' is not an integer from -9 to 9", text_));
    }
    position_ += static_cast<std::size_t>(end - begin);
    return value;
  }

  std::string_view text_;
  const Location& place_;
  std::optional<Dimension> expected_;
  std::size_t position_ = 0;
  int depth_ = 0;
};

}  // namespace

Unit operator*(const Unit& a, const Unit& b) {
  const auto [numerator, denominator] =
      reduced(a.numerator * b.numerator, a.denominator * b.denominator);
  return {numerator,
          denominator,
          {a.dimension.length + b.dimension.length, a.dimension.mass + b.dimension.mass,
           a.dimension.time + b.dimension.time, a.dimension.temperature + b.dimension.temperature,
           a.dimension.current + b.dimension.current}};
}

Unit inverse(const Unit& unit) {
  return {unit.denominator,
          unit.numerator,
          {-unit.dimension.length, -unit.dimension.mass, -unit.dimension.time,
           -unit.dimension.temperature, -unit.dimension.current}};
}

Unit power(const Unit& unit, int exponent) {
  Unit result;
  for (int i = 0; i < std::abs(exponent); ++i) result = result * unit;
  return exponent < 0 ? inverse(result) : result;
}

Unit parse_unit_expression(std::string_view text, const Location& place,
                           std::optional<Dimension> expected) {
  return Parser(text, place, expected).whole();
}

std::string si_unit_name(Dimension dimension) {
  std::string name;
  const auto append = [&](std::string_view unit, int exponent) {
    if (exponent == 0) return;
    if (!name.empty()) name += ' ';
    name += unit;
    if (exponent != 1) name += fmt::format("^{}", exponent);
  };
  append("kg", dimension.mass);
  append("m", dimension.length);
  append("s", dimension.time);
  append("K", dimension.temperature);
  append("A", dimension.current);
  return name.empty() ? "1" : name;
}

}  // namespace sinew
