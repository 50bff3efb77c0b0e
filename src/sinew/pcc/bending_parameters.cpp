#include "sinew/pcc/bending_parameters.hpp"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

namespace {

void require(bool good, const char* item, double value, const char* unit, const char* remedy) {
  if (!std::isfinite(value)) {
    throw Error(ErrorKind::not_finite, {.item = item}, "it is not a finite number", remedy);
  }
  if (good) return;
  throw Error(ErrorKind::out_of_range, {.item = item}, fmt::format("{:g} {}", value, unit), remedy);
}

void positive(const char* item, double value, const char* unit) {
  require(value > 0.0, item, value, unit, "give a number above 0");
}

void not_negative(const char* item, double value, const char* unit) {
  require(value >= 0.0, item, value, unit, "give 0 or more");
}

// Adds a disc of area pi R^2 at height c. Its second moment about the layer is pi R^4/4 + pi R^2
// c^2 (parallel axis theorem).
void add_disc(SectionSum& sum, double radius, double height, double density) {
  const double area = std::numbers::pi * radius * radius;
  sum.total += density * area;
  sum.first += density * area * height;
  sum.second += density * area * (0.25 * radius * radius + height * height);
}

SectionSum sum_of(const BendingParameters& p, double wall, double chamber) {
  SectionSum sum;
  add_disc(sum, p.outer(), p.outer(), wall);
  add_disc(sum, p.chamber_radius, p.chamber_height(), chamber - wall);
  return sum;
}

}  // namespace

void check(const BendingParameters& p) {
  positive("length", p.length, "m");
  positive("chamber_radius", p.chamber_radius, "m");
  positive("wall_thickness", p.wall_thickness, "m");
  const double least = p.chamber_radius + p.wall_thickness;
  require(p.outer() >= least * (1.0 - 1e-12), "outer_radius", p.outer(), "m",
          "give at least chamber_radius + wall_thickness");
  // The model requires a slender body, whose sections can rotate relative to each other.
  require(2.0 * p.outer() < p.length, "outer_radius", p.outer(), "m",
          "give a section that is narrower than the actuator is long");
  positive("silicone_density", p.silicone_density, "kg/m^3");
  not_negative("filling_density", p.filling_density, "kg/m^3");
  not_negative("surroundings_density", p.surroundings_density, "kg/m^3");
  require(true, "inclination", p.inclination, "rad", "give an angle in rad");
  not_negative("gravity", p.gravity, "m/s^2");
  not_negative("mass_damping", p.mass_damping, "1/s");
  not_negative("stiffness_damping", p.stiffness_damping, "s");
  if (p.order && (*p.order < 2 || *p.order > kMaxOrder)) {
    throw Error(ErrorKind::out_of_range, {.item = "order"}, fmt::format("{}", *p.order),
                fmt::format("give 2 to {}, or none for exact energies", kMaxOrder));
  }
}

SectionSum mass_sum(const BendingParameters& p) {
  return sum_of(p, p.silicone_density, p.filling_density);
}

SectionSum net_mass_sum(const BendingParameters& p) {
  return sum_of(p, p.silicone_density - p.surroundings_density,
                p.filling_density - p.surroundings_density);
}

}  // namespace sinew::pcc
