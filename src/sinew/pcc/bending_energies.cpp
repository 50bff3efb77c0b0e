#include "sinew/pcc/bending_energies.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <tuple>
#include <vector>

#include "sinew/pcc/gauss.hpp"

namespace sinew::pcc {

namespace {

Derivatives horner(const auto& coefficients, int order, double x) {
  Derivatives sum;
  for (auto k = static_cast<std::size_t>(order) + 1; k-- > 0;) {
    sum.second = sum.second * x + 2.0 * sum.first;
    sum.first = sum.first * x + sum.value;
    sum.value = sum.value * x + coefficients[k];
  }
  return sum;
}

double factorial(int n) { return std::tgamma(n + 1.0); }

}  // namespace

BendingEnergies::BendingEnergies(const BendingParameters& p)
    : length_(p.length),
      far_side_(2.0 * p.outer()),
      lowest_(-std::min(2.0 * std::numbers::pi, 0.9 * p.length / far_side_)),
      highest_(2.0 * std::numbers::pi),
      reduced_(p.order.has_value()) {
  prepare_across(p);
  prepare_along(p);
  if (p.order) expand(*p.order);
}

// int_disc f(h) dA = 2 R^2 int_-1^1 f(c + R x) sqrt(1 - x^2) dx, by Gauss-Chebyshev quadrature of
// the second kind: points cos(i pi/(n + 1)), weights pi/(n + 1) sin^2(i pi/(n + 1)).
void BendingEnergies::prepare_across(const BendingParameters& p) {
  const auto disc = [&](std::size_t from, double radius, double centre, double sign) {
    for (std::size_t i = 0; i < kAcross; ++i) {
      const double angle = static_cast<double>(i + 1) * std::numbers::pi / (kAcross + 1);
      height_[from + i] = centre + radius * std::cos(angle);
      area_[from + i] = sign * 2.0 * radius * radius * std::numbers::pi / (kAcross + 1) *
                        std::sin(angle) * std::sin(angle);
    }
  };
  disc(0, p.outer(), p.outer(), 1.0);
  disc(kAcross, p.chamber_radius, p.chamber_height(), -1.0);
}

void BendingEnergies::prepare_along(const BendingParameters& p) {
  SectionSum mass = mass_sum(p), net = net_mass_sum(p);
  if (p.mass_line == MassLine::layer) mass.first = mass.second = net.first = 0.0;
  const double l = p.length;
  // Height of a point (x, axial): x sin(inclination) - axial cos(inclination).
  const double lift = p.gravity * std::sin(p.inclination);
  const double hang = p.gravity * std::cos(p.inclination);
  const std::vector<GaussPoint> points = gauss_points(kAlong);
  for (std::size_t i = 0; i < kAlong; ++i) {
    const double t = points[i].at, w = points[i].weight;
    const double t3 = t * t * t;
    const double k = 2.0 * ((1.0 - t3) / 3.0 - 0.25 * (1.0 - t3 * t) - 0.5 * t * (1.0 - t * t) +
                            t * (1.0 - t3) / 3.0);
    const double k1 = (1.0 - t3) / 3.0 - 0.5 * t * (1.0 - t * t);
    at_[i] = t;
    inertia_waves_.cosine[i] = w * mass.total * l * l * l * k;
    inertia_waves_.sine[i] = w * 2.0 * l * l * mass.first * k1;
    const double line = net.total * l * l * (1.0 - t), offset = net.first * l;
    gravity_waves_.sine[i] = w * (lift * line - hang * offset);
    gravity_waves_.cosine[i] = -w * (hang * line + lift * offset);
  }
  inertia_constant_ = mass.second * l / 3.0;
}

// Taylor coefficient of the waves: d^n/dtheta^n at 0, divided by n!.
double BendingEnergies::coefficient(const Waves& waves, int power) const {
  const auto& side = power % 2 == 0 ? waves.cosine : waves.sine;
  double sum = 0.0;
  for (std::size_t i = 0; i < kAlong; ++i) sum += side[i] * std::pow(at_[i], power);
  return (power % 4 < 2 ? sum : -sum) / factorial(power);
}

double BendingEnergies::wall_moment(int power) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < height_.size(); ++i) sum += area_[i] * std::pow(height_[i], power);
  return sum;
}

void BendingEnergies::expand(int order) {
  order_ = order;
  for (int n = 0; n <= order; ++n) {
    const auto k = static_cast<std::size_t>(n);
    inertia_[k] = coefficient(inertia_waves_, n);
    gravity_[k] = coefficient(gravity_waves_, n);
    // (lambda - 1/lambda)^2 = lambda^2 - 2 + lambda^-2: 4 e^2, then (-1)^n (n + 1) e^n.
    const double series = n < 2 ? 0.0 : n == 2 ? 4.0 : (n % 2 == 0 ? n + 1.0 : -(n + 1.0));
    strain_[k] = 0.5 * series * wall_moment(n) * std::pow(length_, 1 - n);
  }
  inertia_[0] += inertia_constant_;
}

BendingTerms BendingEnergies::polynomials(double theta) const {
  return {horner(strain_, order_, theta), horner(gravity_, order_, theta),
          horner(inertia_, order_, theta)};
}

BendingTerms BendingEnergies::exact(double theta) const {
  BendingTerms terms;
  for (std::size_t i = 0; i < kAlong; ++i) {
    const double t = at_[i], c = std::cos(t * theta), s = std::sin(t * theta);
    const auto add = [&](Derivatives& sum, const Waves& waves) {
      const double value = waves.cosine[i] * c + waves.sine[i] * s;
      sum.value += value;
      sum.first += t * (waves.sine[i] * c - waves.cosine[i] * s);
      sum.second -= t * t * value;
    };
    add(terms.inertia, inertia_waves_);
    add(terms.gravity, gravity_waves_);
  }
  terms.inertia.value += inertia_constant_;
  // W = (lambda - 1/lambda)^2 / 2 and its derivatives with respect to e, without cancellation at e
  // = 0.
  for (std::size_t i = 0; i < height_.size(); ++i) {
    const double e = theta / length_ * height_[i], stretch = 1.0 + e, inverse = 1.0 / stretch;
    const double difference = e * (2.0 + e) * inverse;  // lambda - 1/lambda
    const double sum = stretch + inverse, weight = area_[i] * height_[i];
    terms.strain.value += 0.5 * length_ * area_[i] * difference * difference;
    terms.strain.first += weight * difference * sum * inverse;  // lambda - lambda^-3
    terms.strain.second +=
        weight * height_[i] / length_ * (1.0 + 3.0 * inverse * inverse * inverse * inverse);
  }
  return terms;
}

// The remainder of each cos(t theta) and sin(t theta) is bounded by the next term of its series.
std::pair<double, double> BendingEnergies::wave_bound(const Waves& waves, int order,
                                                      double angle) const {
  double value = 0.0, slope = 0.0;
  for (const int parity : {0, 1}) {
    const int next = order + 1 + (order + 1 + parity) % 2;  // even for cosines
    const auto& side = parity == 0 ? waves.cosine : waves.sine;
    for (std::size_t i = 0; i < kAlong; ++i) {
      const double last = std::abs(side[i]) * at_[i] * std::pow(at_[i] * angle, next - 1);
      value += last * angle / factorial(next);
      slope += last / factorial(next - 1);
    }
  }
  return {value, slope};
}

// Lagrange's remainder of (1 + e)^-2 after e^N is (N + 2) e^(N+1) (1 + xi)^-(N+3), with xi between
// 0 and e. It is largest at xi = 0 for e > 0, and at e of the far side for e < 0.
std::pair<double, double> BendingEnergies::strain_bound(double angle) const {
  const int next = order_ + 1;
  const double most = std::min(0.0, angle / length_ * far_side_);
  const double slope = 0.5 * (next + 1.0) * next * wall_moment(next) *
                       std::pow(std::abs(angle) / length_, next - 1) *
                       std::pow(1.0 + most, -(next + 2));
  return {slope * std::abs(angle) / next, slope};
}

TaylorBound BendingEnergies::bound(double lowest, double highest) const {
  TaylorBound result;
  if (!reduced_) return result;
  const double farthest = std::max(std::abs(lowest), std::abs(highest));
  for (const double angle : {lowest, highest}) {
    const auto [value, slope] = strain_bound(angle);
    result.strain = std::max(result.strain, value);
    result.strain_slope = std::max(result.strain_slope, slope);
  }
  std::tie(result.gravity, result.gravity_slope) = wave_bound(gravity_waves_, order_, farthest);
  result.inertia = wave_bound(inertia_waves_, order_, farthest).first;
  return result;
}

}  // namespace sinew::pcc
