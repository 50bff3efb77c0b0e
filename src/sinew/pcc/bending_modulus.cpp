#include "sinew/pcc/bending_modulus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

namespace {

constexpr std::array<std::string_view, 3> kKinds{"shear", "young", "bending"};
constexpr std::array<std::string_view, 2> kOutside{"refuse", "hold"};

template <std::size_t N>
std::size_t choose(std::string_view name, const std::array<std::string_view, N>& choices,
                   const char* item) {
  const auto found = std::find(choices.begin(), choices.end(), name);
  if (found != choices.end()) return static_cast<std::size_t>(found - choices.begin());
  throw Error(ErrorKind::unknown_choice, {.item = item}, fmt::format("there is no '{}'", name),
              fmt::format("use one of {}", fmt::join(choices, ", ")));
}

double shear_per_unit(ModulusKind kind) {
  return kind == ModulusKind::shear ? 1.0 : kind == ModulusKind::young ? 1.0 / 3.0 : 0.25;
}

double horner(const std::vector<double>& coefficients, double x) {
  double sum = 0.0;
  for (std::size_t k = coefficients.size(); k-- > 0;) sum = sum * x + coefficients[k];
  return sum;
}

}  // namespace

ModulusKind to_modulus_kind(std::string_view name) {
  return static_cast<ModulusKind>(choose(name, kKinds, "kind"));
}

std::string_view modulus_kind_name(ModulusKind kind) {
  return kKinds[static_cast<std::size_t>(kind)];
}

OutsideRange to_outside_range(std::string_view name) {
  return static_cast<OutsideRange>(choose(name, kOutside, "outside"));
}

std::string_view outside_range_name(OutsideRange outside) {
  return kOutside[static_cast<std::size_t>(outside)];
}

BendingModulus::BendingModulus(double value, ModulusKind kind)
    : coefficients_{value},
      kind_(kind),
      constant_(true),
      lowest_(-std::numeric_limits<double>::infinity()),
      highest_(std::numeric_limits<double>::infinity()),
      per_unit_(shear_per_unit(kind)) {
  if (!std::isfinite(value)) {
    throw Error(ErrorKind::not_finite, {.item = "modulus"}, "it is not a finite number",
                "give it in Pa");
  }
  if (!(value > 0.0)) {
    throw Error(ErrorKind::out_of_range, {.item = "modulus"}, fmt::format("{:g} Pa", value),
                "give a modulus above 0 Pa");
  }
}

BendingModulus::BendingModulus(std::vector<double> coefficients, ModulusKind kind, double lowest,
                               double highest, OutsideRange outside)
    : coefficients_(std::move(coefficients)),
      kind_(kind),
      outside_(outside),
      lowest_(lowest),
      highest_(highest),
      per_unit_(shear_per_unit(kind)) {
  const Location place{.item = "modulus"};
  if (coefficients_.empty()) {
    throw Error(ErrorKind::empty_list, place, "the polynomial has no coefficient",
                "give them from the constant one on");
  }
  for (const double c : coefficients_) {
    if (std::isfinite(c)) continue;
    throw Error(ErrorKind::not_finite, place, "a coefficient is not a finite number",
                "give Pa/Pa^k for power k");
  }
  if (!(std::isfinite(lowest) && std::isfinite(highest) && lowest < highest)) {
    throw Error(ErrorKind::contradictory_limits, place,
                fmt::format("a range from {:g} to {:g} Pa", lowest, highest),
                "give the pressures that the polynomial was fitted to, the lower first");
  }
  constexpr int kSamples = 1000;
  for (int k = 0; k <= kSamples; ++k) {
    const double pressure = lowest + (highest - lowest) * k / kSamples;
    const double found = horner(coefficients_, pressure);
    if (found > 0.0) continue;
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("the polynomial is {:g} Pa at {:g} Pa", found, pressure),
                "a modulus is above 0 Pa; narrow the range or check the coefficients");
  }
}

BendingModulus BendingModulus::published(OutsideRange outside) {
  return {{6.562e5, 15.97, -5.566e-4, 8.535e-9, -6.36e-14, 1.795e-19},
          ModulusKind::bending,
          10e3,
          110e3,
          outside};
}

double BendingModulus::polynomial(double pressure) const {
  const double inside = std::clamp(pressure, lowest_, highest_);
  // Also true for NaN.
  if (!(inside == pressure) && outside_ == OutsideRange::refuse) {
    throw Error(ErrorKind::out_of_range, {.item = "pressure"},
                fmt::format("{:g} Pa; the modulus was fitted at {:g} to {:g} Pa", pressure, lowest_,
                            highest_),
                "keep within, or have it hold its value at the nearer end");
  }
  return horner(coefficients_, inside);
}

}  // namespace sinew::pcc
