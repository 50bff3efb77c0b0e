#include "sinew/pcc/drive_cylinder.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::pcc {

namespace {

void require(bool good, ErrorKind kind, const std::string& message, const char* remedy) {
  if (!good) throw Error(kind, {.item = "drive cylinder"}, message, remedy);
}

/// exp(-s h) cos(n h) and exp(-s h) sin(n h) / n, with s = zeta w and n^2 = w^2 - s^2. For n^2 < 0
/// they are the hyperbolic counterparts, in a form without overflow and cancellation.
struct Decay {
  double even = 0.0, odd = 0.0;
};

Decay decay(double w, double zeta, double h) {
  const double s = zeta * w, square = w * w * (1.0 - zeta) * (1.0 + zeta);
  if (square > 0.0) {
    const double n = std::sqrt(square), envelope = std::exp(-s * h);
    return {envelope * std::cos(n * h), envelope * std::sin(n * h) / n};
  }
  const double m = std::sqrt(-square);
  const double slow = std::exp(-w * w / (s + m) * h), fast = std::exp(-(s + m) * h);
  return {0.5 * (slow + fast), m > 0.0 ? slow * -std::expm1(-2.0 * m * h) / (2.0 * m) : slow * h};
}

}  // namespace

DriveCylinder DriveCylinder::second_order(double gain, double frequency, double damping,
                                          double sample_time) {
  require(frequency > 0.0 && damping >= 0.0 && sample_time > 0.0 && std::isfinite(gain),
          ErrorKind::out_of_range,
          fmt::format("gain {:g}, {:g} rad/s, damping {:g}, sampled by {:g} s", gain, frequency,
                      damping, sample_time),
          "give frequency and sample time above zero, damping zero or more");
  // The system is x' = F x + G u with F = w [0 1; -1 -2 zeta] and G = [0; w]. With s = zeta w,
  // (F + s I)^2 = (s^2 - w^2) I, so A = exp(F h) = even I + odd (F + s I). The equilibrium for a
  // constant command u is [u; 0], so B = F^-1 (A - I) G = (I - A) [1; 0].
  const auto [even, odd] = decay(frequency, damping, sample_time);
  const double rate = damping * frequency;
  DriveCylinder cylinder;
  cylinder.a << even + rate * odd, frequency * odd, -frequency * odd, even - rate * odd;
  cylinder.b << 1.0 - cylinder.a(0, 0), -cylinder.a(1, 0);
  cylinder.c << gain, 0.0;
  cylinder.sample_time = sample_time;
  return cylinder;
}

void DriveCylinder::check() const {
  require(a.allFinite() && b.allFinite() && c.allFinite() && std::isfinite(d),
          ErrorKind::not_finite, "a coefficient is not finite", "give numbers");
  require(sample_time > 0.0 && std::isfinite(sample_time), ErrorKind::out_of_range,
          fmt::format("the sample time is {:g} s", sample_time), "give more than zero");
  require(spectral_radius() < 1.0, ErrorKind::out_of_range,
          fmt::format("an eigenvalue of A has size {:g}", spectral_radius()),
          "a cylinder is stable: all are below 1");
  require(lowest_input < highest_input && lowest_volume < highest_volume,
          ErrorKind::contradictory_limits,
          fmt::format("commands {:g} to {:g}, volumes {:g} to {:g}", lowest_input, highest_input,
                      lowest_volume, highest_volume),
          "give lowest < highest");
}

double DriveCylinder::gain() const { return c.dot(rest(1.0)) + d; }

Eigen::Vector2d DriveCylinder::rest(double command) const {
  return (Eigen::Matrix2d::Identity() - a).inverse() * b * command;
}

double DriveCylinder::spectral_radius() const {
  const double mean = 0.5 * a.trace(), half = 0.5 * (a(0, 0) - a(1, 1));
  const double square = half * half + a(0, 1) * a(1, 0);  // of half their difference
  return square < 0.0 ? std::hypot(mean, std::sqrt(-square)) : std::abs(mean) + std::sqrt(square);
}

VectorX DriveCylinder::simulate(const VectorX& command, const Eigen::Vector2d& start) const {
  check();
  VectorX volume(command.size());
  Eigen::Vector2d x = start;
  for (Eigen::Index k = 0; k < command.size(); ++k) {
    const double u = std::clamp(command[k], lowest_input, highest_input);
    volume[k] = std::clamp(c.dot(x) + d * u, lowest_volume, highest_volume);
    x = a * x + b * u;
  }
  return volume;
}

}  // namespace sinew::pcc
