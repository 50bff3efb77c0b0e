#include "sinew/model/fluid_drive.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/model/require.hpp"

namespace sinew::model {

namespace {

// Above this pressure ratio, the flow is linear to zero.
constexpr double kLinear = 0.999;
// Minimum volume of a chamber relative to its volume at rest, below which the gas law would be
// singular.
constexpr double kMinVolume = 1e-3;

void check(const std::optional<Supply>& supply) {
  if (!supply) return;
  require(supply->conductance > 0.0, "conductance", supply->conductance,
          "give a positive one, such as 2e-9 m^3/(s Pa)");
  require(supply->critical_ratio >= 0.0 && supply->critical_ratio < 1.0, "critical_ratio",
          supply->critical_ratio, "give 0 or more, below 1; 0.5 is usual");
  require(supply->leak >= 0.0, "leak", supply->leak, "give zero or more");
}

double total_volume(double rest_volume, double dead_volume) {
  require(dead_volume >= 0.0, "dead_volume", dead_volume, "give zero or more");
  const double volume = rest_volume + dead_volume;
  if (!(volume > 0.0)) {
    throw Error(ErrorKind::zero_volume, {.item = "chamber"},
                fmt::format("the chamber's volume is {:g} m^3", volume),
                "choose the inside of a chamber");
  }
  return volume;
}

struct Flow {
  double flow, slope;  // m^3/s, and its derivative by the downstream pressure
};

// Flow from the absolute pressure `up` to `down` < up.
Flow forward(double conductance, double critical, double up, double down) {
  const double ratio = down / up;
  if (ratio <= critical) return {conductance * up, 0.0};
  const auto shape = [&](double r) {
    const double s = (r - critical) / (1.0 - critical);
    return std::sqrt(std::max(0.0, 1.0 - s * s));
  };
  if (ratio >= kLinear) {
    const double slope = -shape(kLinear) / (1.0 - kLinear);
    return {conductance * up * slope * (ratio - 1.0), conductance * slope};
  }
  const double s = (ratio - critical) / (1.0 - critical);
  return {conductance * up * shape(ratio), -conductance * s / ((1.0 - critical) * shape(ratio))};
}

// Flow into a chamber at `inside` from `outside`, in either direction; slope by `inside`.
Flow inflow(double conductance, double critical, double outside, double inside) {
  if (conductance == 0.0) return {0.0, 0.0};
  if (outside >= inside) return forward(conductance, critical, outside, inside);
  const Flow out = forward(conductance, critical, inside, outside);
  // q(up, down) is homogeneous of degree one: up dq/dup = q - down dq/ddown.
  return {-out.flow, -(out.flow - outside * out.slope) / inside};
}

}  // namespace

GasDrive::GasDrive(const GasSettings& settings, double rest_volume)
    : settings_(settings), rest_volume_(total_volume(rest_volume, settings.dead_volume)) {
  require(settings.ambient_pressure > 0.0, "ambient_pressure", settings.ambient_pressure,
          "give an absolute pressure, 101325 Pa at sea level");
  require(settings.exponent >= 1.0, "polytropic_exponent", settings.exponent,
          "give 1 for slow, 1.4 for fast processes");
  check(settings.supply);
}

void GasDrive::rest(std::span<double> state) const { state[0] = rest_volume_; }

void GasDrive::describe(PartVisitor& visitor) const {
  visitor.below("gas", [&] {
    visitor.number("ambient_pressure", "Pa", settings_.ambient_pressure)
        .number("polytropic_exponent", "", settings_.exponent);
    visitor.optional(settings_.supply,
                     [](PartVisitor& of, const Supply& s) { s.describe(of, true); });
    visitor.add(rest_volume_).list("dead_volume", "m^3", settings_.dead_volume);
  });
}

bool GasDrive::acts_on(CommandKind kind) const {
  return kind == CommandKind::input || (kind == CommandKind::effort && settings_.supply);
}

double GasDrive::volume(double motion) const {
  return std::max(rest_volume_ + motion, kMinVolume * rest_volume_);
}

Drive::Response GasDrive::respond(const Step& step, double motion) const {
  const double v = volume(motion);
  if (step.kind != CommandKind::input) return fed(step, v);
  const double content = std::max(0.0, rest_volume_ + step.command);
  const double pressure = settings_.ambient_pressure * std::pow(content / v, settings_.exponent);
  return {pressure - settings_.ambient_pressure, -settings_.exponent * pressure / v};
}

// Backward Euler for the content: v_f = v_i + h (q_in(p) - q_out(p)), p = p_ambient (v_f / V)^k.
// The pressure from the gas law decreases with p, so there is one root, found by Newton's method
// with bisection.
Drive::Response GasDrive::fed(const Step& step, double volume) const {
  const Supply& supply = *settings_.supply;
  const double ambient = settings_.ambient_pressure, k = settings_.exponent;
  const double source = std::max(0.0, ambient + step.command);
  const bool forever = std::isinf(step.time_step);
  const auto net = [&](double p) {
    const Flow in = inflow(supply.conductance, supply.critical_ratio, source, p);
    const Flow out = inflow(supply.leak, supply.critical_ratio, ambient, p);
    return Flow{in.flow + out.flow, in.slope + out.slope};
  };
  // The residual increases with p: p minus the gas law, or in the steady state the outflow.
  struct Value {
    double value, slope;
  };
  const auto residual = [&](double p) -> Value {
    const Flow flow = net(p);
    if (forever) return {-flow.flow, -flow.slope};
    const double content = std::max(0.0, step.state[0] + step.time_step * flow.flow);
    const double law = ambient * std::pow(content / volume, k);
    const double slope = content > 0.0 ? k * law / content * step.time_step * flow.slope : 0.0;
    return {p - law, 1.0 - slope};
  };
  const double before = ambient * std::pow(step.state[0] / volume, k);
  double low = 0.0, high = std::max({source, before, ambient});
  double p = std::clamp(before, low, high);
  Value at = residual(p);
  for (int i = 0; i < 200 && high - low > 1e-14 * high; ++i) {
    if (at.value == 0.0) break;
    (at.value > 0.0 ? high : low) = p;
    const double newton = p - at.value / at.slope;
    const bool inside = at.slope > 0.0 && newton > low && newton < high;
    const double next = inside ? newton : 0.5 * (low + high);
    if (std::abs(next - p) <= 1e-15 * high) break;
    p = next;
    at = residual(p);
  }
  if (forever) return {p - ambient, 0.0};
  return {p - ambient, -k * p / volume / at.slope};
}

void GasDrive::advance(const Step&, double motion, double effort, std::span<double> state) const {
  const double pressure = std::max(0.0, effort + settings_.ambient_pressure);
  state[0] =
      volume(motion) * std::pow(pressure / settings_.ambient_pressure, 1.0 / settings_.exponent);
}

LiquidDrive::LiquidDrive(const LiquidSettings& settings, double rest_volume)
    : settings_(settings),
      stiffness_(settings.bulk_modulus / total_volume(rest_volume, settings.dead_volume)) {
  require(settings.bulk_modulus > 0.0, "bulk_modulus", settings.bulk_modulus,
          "give that of the liquid: 2.2 GPa for water");
  require(settings.density >= 0.0, "density", settings.density, "give zero or more");
  check(settings.supply);
}

void LiquidDrive::describe(PartVisitor& visitor) const {
  visitor.below("liquid", [&] {
    visitor.number("density", "kg/m^3", settings_.density);
    visitor.optional(settings_.supply,
                     [](PartVisitor& of, const Supply& s) { s.describe(of, false); });
    visitor.add(stiffness_).list("bulk_modulus", "Pa", settings_.bulk_modulus);
    visitor.list("dead_volume", "m^3", settings_.dead_volume);
  });
}

bool LiquidDrive::acts_on(CommandKind kind) const {
  return kind == CommandKind::input || (kind == CommandKind::effort && settings_.supply);
}

// p = s (x - motion) with the added liquid x; with a supply: x = x_i + h (C (p_s - p) - L p).
Drive::Response LiquidDrive::respond(const Step& step, double motion) const {
  if (step.kind == CommandKind::input) {
    return {stiffness_ * (step.command - motion), -stiffness_};
  }
  const Supply& supply = *settings_.supply;
  const double both = supply.conductance + supply.leak;
  if (std::isinf(step.time_step)) return {supply.conductance * step.command / both, 0.0};
  const double softer = 1.0 + stiffness_ * step.time_step * both;
  const double filled = step.state[0] + step.time_step * supply.conductance * step.command;
  return {stiffness_ * (filled - motion) / softer, -stiffness_ / softer};
}

void LiquidDrive::advance(const Step&, double motion, double effort,
                          std::span<double> state) const {
  state[0] = motion + effort / stiffness_;
}

}  // namespace sinew::model
