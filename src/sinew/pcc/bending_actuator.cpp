#include "sinew/pcc/bending_actuator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

namespace {

const BendingParameters& checked(const BendingParameters& parameters) {
  check(parameters);
  return parameters;
}

double wall_second_moment(BendingParameters p) {
  p.silicone_density = 1.0;
  p.filling_density = 0.0;
  return mass_sum(p).second;
}

// sin(x)/x and (1 - cos x)/x, without division by small x.
double sinc(double x) { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }
double versinc(double x) { return std::sin(0.5 * x) * sinc(0.5 * x); }

}  // namespace

BendingActuator::BendingActuator(const BendingParameters& parameters)
    : parameters_(checked(parameters)),
      energies_(parameters_),
      mass_(mass_sum(parameters_).total * parameters_.length),
      net_weight_(net_mass_sum(parameters_).total * parameters_.length * parameters_.gravity),
      second_moment_(wall_second_moment(parameters_)),
      moment_per_pressure_(std::numbers::pi * parameters_.chamber_radius *
                           parameters_.chamber_radius * parameters_.chamber_height()),
      viscosity_(parameters_.stiffness_damping * 4.0 * second_moment_ / parameters_.length) {}

double BendingActuator::chamber_volume(double theta) const {
  const double r = parameters_.chamber_radius;
  return std::numbers::pi * r * r * parameters_.length + moment_per_pressure_ * theta;
}

BendingTerms BendingActuator::terms(double theta) const {
  // Also false for NaN.
  if (theta >= energies_.lowest_angle() && theta <= energies_.highest_angle()) {
    return energies_.at(theta);
  }
  throw Error(ErrorKind::out_of_range, {.item = "theta"}, fmt::format("{:g} rad", theta),
              fmt::format("the model holds from {:g} to {:g} rad", energies_.lowest_angle(),
                          energies_.highest_angle()));
}

BendingEnergy BendingActuator::energy(double theta, double rate, double pressure) const {
  const BendingTerms t = terms(theta);
  return {parameters_.modulus.shear(pressure) * t.strain.value, t.gravity.value,
          0.5 * t.inertia.value * rate * rate};
}

double BendingActuator::acceleration(double theta, double rate, double pressure) const {
  const BendingTerms t = terms(theta);
  const double shear = parameters_.modulus.shear(pressure);
  const double inertia = t.inertia.value;
  return (moment_per_pressure_ * pressure - shear * t.strain.first - t.gravity.first -
          0.5 * t.inertia.first * rate * rate - damping(inertia, shear) * rate) /
         inertia;
}

double BendingActuator::stiffness(double theta, double pressure) const {
  const BendingTerms t = terms(theta);
  return parameters_.modulus.shear(pressure) * t.strain.second + t.gravity.second;
}

double BendingActuator::linear_angle(double pressure) const {
  return moment_per_pressure_ * pressure * parameters_.length /
         (4.0 * parameters_.modulus.shear(pressure) * second_moment_);
}

double BendingActuator::equilibrium(double pressure, double start) const {
  constexpr int kMaxIterations = 100;
  constexpr double kLongestStep = 0.3;  // rad
  const double shear = parameters_.modulus.shear(pressure);
  const double moment = moment_per_pressure_ * pressure;
  const double lowest = energies_.lowest_angle(), highest = energies_.highest_angle();
  double theta = std::clamp(start, lowest, highest);
  for (int k = 0; k < kMaxIterations; ++k) {
    const BendingTerms terms = energies_.at(theta);
    const double force = moment - shear * terms.strain.first - terms.gravity.first;
    const double stiffness = shear * terms.strain.second + terms.gravity.second;
    // In an unstable pose, Newton's method would climb. The search takes the longest step downhill.
    const double wanted = stiffness > 0.0 ? force / stiffness : std::copysign(kLongestStep, force);
    const double next =
        std::clamp(theta + std::clamp(wanted, -kLongestStep, kLongestStep), lowest, highest);
    const double step = next - theta;
    theta = next;
    if (std::abs(wanted) < 1e-9 && stiffness > 0.0) return theta;
    if (step == 0.0) break;
  }
  throw Error(
      ErrorKind::not_converged, {.item = "equilibrium"},
      fmt::format("no stable angle was found at {:g} Pa; the search ended at {:g} rad", pressure,
                  theta),
      "lower the pressure or the weight, or use exact energies: Taylor models of odd order give "
      "way at large angles");
}

Eigen::Vector2d BendingActuator::point(double theta, double fraction) const {
  const double angle = fraction * theta, s = fraction * parameters_.length;
  const double aside = s * versinc(angle), along = s * sinc(angle);
  const double sine = std::sin(parameters_.inclination), cosine = std::cos(parameters_.inclination);
  return {aside * cosine + along * sine, aside * sine - along * cosine};
}

BendingError BendingActuator::taylor_error(double lowest, double highest, double pressure) const {
  const Location place{.item = "taylor_error"};
  if (!(lowest <= highest)) {
    throw Error(ErrorKind::contradictory_limits, place,
                fmt::format("from {:g} to {:g} rad", lowest, highest),
                "give the lower angle first");
  }
  if (lowest < energies_.lowest_angle() || highest > energies_.highest_angle()) {
    throw Error(ErrorKind::out_of_range, place,
                fmt::format("from {:g} to {:g} rad", lowest, highest),
                fmt::format("the model holds from {:g} to {:g} rad", energies_.lowest_angle(),
                            energies_.highest_angle()));
  }
  const TaylorBound bound = energies_.bound(lowest, highest);
  const double shear = parameters_.modulus.shear(pressure);
  return {shear * bound.strain, bound.gravity, bound.inertia,
          shear * bound.strain_slope + bound.gravity_slope};
}

}  // namespace sinew::pcc
