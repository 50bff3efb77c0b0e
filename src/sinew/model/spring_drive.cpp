#include "sinew/model/spring_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/model/require.hpp"

namespace sinew::model {

namespace {

// Tension at the end of a step of a spring and a damper in parallel.
Drive::Response pull(double stiffness, double free_length, double damping, double rest_length,
                     const Drive::Step& step, double motion) {
  // dL/dt = -(motion - motion_before)/h; zero in the steady state.
  const double rate = std::isinf(step.time_step) ? 0.0 : damping / step.time_step;
  const double tension =
      stiffness * (rest_length - motion - free_length) - rate * (motion - step.motion_before);
  return {tension, -stiffness - rate};
}

// 0 below `cold`, 1 above `hot`, half a cosine wave in between.
double ramp(double temperature, double cold, double hot) {
  const double part = std::clamp((temperature - cold) / (hot - cold), 0.0, 1.0);
  return 0.5 * (1.0 - std::cos(std::numbers::pi * part));
}

}  // namespace

double coil_stiffness(double shear_modulus, double wire, double mean_diameter, double coils) {
  return shear_modulus * std::pow(wire, 4) / (8.0 * coils * std::pow(mean_diameter, 3));
}

SpringDrive::SpringDrive(const SpringSettings& settings, double rest_length)
    : settings_(settings), rest_length_(rest_length) {
  require(settings.stiffness > 0.0, "stiffness", settings.stiffness, "give a positive one in N/m");
  require(settings.free_length >= 0.0, "free_length", settings.free_length, "give zero or more");
  require(settings.damping >= 0.0, "damping", settings.damping, "give zero or more");
}

Drive::Response SpringDrive::respond(const Step& step, double motion) const {
  const Response both = pull(settings_.stiffness, settings_.free_length, settings_.damping,
                             rest_length_, step, motion);
  if (settings_.tension_only && both.effort < 0.0) return {0.0, 0.0};
  return both;
}

SmaDrive::SmaDrive(const SmaSettings& s, double rest_length)
    : settings_(s), rest_length_(rest_length) {
  require(s.wire > 0.0, "wire_diameter", s.wire, "give a positive one");
  require(s.mean_diameter > s.wire, "mean_diameter", s.mean_diameter, "give more than the wire's");
  require(s.coils > 0.0, "coils", s.coils, "give the number of active coils");
  require(s.martensite_modulus > 0.0, "martensite_modulus", s.martensite_modulus,
          "give a positive one");
  require(s.austenite_modulus > 0.0, "austenite_modulus", s.austenite_modulus,
          "give a positive one");
  require(s.free_length >= 0.0, "free_length", s.free_length, "give zero or more");
  require(s.damping >= 0.0, "damping", s.damping, "give zero or more");
  require(s.heat_capacity > 0.0, "heat_capacity", s.heat_capacity, "give a positive one in J/K");
  require(s.heat_loss > 0.0, "heat_loss", s.heat_loss, "give a positive one in W/K");
  require(s.austenite_end > s.austenite_start, "austenite_end", s.austenite_end,
          "give more than austenite_start");
  require(s.martensite_end < s.martensite_start, "martensite_end", s.martensite_end,
          "give less than martensite_start");
}

void SmaDrive::rest(std::span<double> state) const {
  state[0] = settings_.ambient;
  state[1] = ramp(settings_.ambient, settings_.martensite_end, settings_.martensite_start);
}

SmaDrive::Wire SmaDrive::wire_after(const Step& step) const {
  const double phase = step.state[1];
  if (settings_.by_phase) {
    const bool told = step.kind == CommandKind::input;
    return {step.state[0], told ? std::clamp(step.command, 0.0, 1.0) : phase};
  }
  const double power = step.kind == CommandKind::input ? std::max(0.0, step.command) : 0.0;
  const double end = settings_.ambient + power / settings_.heat_loss;
  const double share =
      std::isinf(step.time_step)
          ? 1.0
          : 1.0 / (1.0 + settings_.heat_capacity / (settings_.heat_loss * step.time_step));
  const double temperature = std::lerp(step.state[0], end, share);
  if (temperature >= step.state[0]) {
    return {temperature,
            std::max(phase, ramp(temperature, settings_.austenite_start, settings_.austenite_end))};
  }
  return {temperature,
          std::min(phase, ramp(temperature, settings_.martensite_end, settings_.martensite_start))};
}

Drive::Response SmaDrive::respond(const Step& step, double motion) const {
  const double modulus =
      std::lerp(settings_.martensite_modulus, settings_.austenite_modulus, wire_after(step).phase);
  return pull(coil_stiffness(modulus, settings_.wire, settings_.mean_diameter, settings_.coils),
              settings_.free_length, settings_.damping, rest_length_, step, motion);
}

void SmaDrive::advance(const Step& step, double, double, std::span<double> state) const {
  const Wire wire = wire_after(step);
  state[0] = wire.temperature;
  state[1] = wire.phase;
}

void SmaDrive::describe(PartVisitor& visitor) const {
  const SmaSettings& s = settings_;
  visitor.below("shape_memory", [&] {
    visitor.number("wire_diameter", "m", s.wire)
        .number("mean_diameter", "m", s.mean_diameter)
        .number("coils", "", s.coils)
        .number("martensite_modulus", "Pa", s.martensite_modulus)
        .number("austenite_modulus", "Pa", s.austenite_modulus);
  });
  visitor.number("free_length", "m", s.free_length).number("damping", "N s/m", s.damping);
  visitor.below("shape_memory", [&] {
    visitor.number("heat_capacity", "J/K", s.heat_capacity)
        .number("heat_loss", "W/K", s.heat_loss)
        .number("ambient", "K", s.ambient)
        .number("austenite_start", "K", s.austenite_start)
        .number("austenite_end", "K", s.austenite_end)
        .number("martensite_start", "K", s.martensite_start)
        .number("martensite_end", "K", s.martensite_end);
  });
  visitor.add(s.by_phase, rest_length_);
}

}  // namespace sinew::model
