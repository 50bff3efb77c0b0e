#include "sinew/material/hyperelastic.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/material/principal.hpp"

namespace sinew::material {

namespace {

[[noreturn]] void fail(const std::string& what, const std::string& message,
                       const std::string& remedy) {
  throw Error(ErrorKind::invalid_material, {.item = what}, message, remedy);
}

}  // namespace

double Hyperelastic::shear_modulus() const {
  if (saint_venant_shear > 0.0) return saint_venant_shear;
  double sum = polynomial.empty() ? 0.0 : 2.0 * polynomial.front();
  for (const PowerTerm& term : powers) {
    sum += 0.5 * term.coefficient * term.exponent * term.exponent;
  }
  return sum;
}

double Hyperelastic::long_term_share() const {
  double share = 1.0;
  for (const PronyTerm& term : prony) share -= term.relative_modulus;
  return share;
}

double Hyperelastic::young_modulus() const {
  const double mu = shear_modulus();
  return 9.0 * bulk_modulus * mu / (3.0 * bulk_modulus + mu);
}

double Hyperelastic::poisson_ratio() const {
  const double mu = shear_modulus();
  return (3.0 * bulk_modulus - 2.0 * mu) / (6.0 * bulk_modulus + 2.0 * mu);
}

void Hyperelastic::validate(const std::string& what) const {
  for (const PowerTerm& term : powers) {
    if (!std::isfinite(term.coefficient) || !std::isfinite(term.exponent)) {
      fail(what, "a coefficient is not finite", "give finite numbers");
    }
    if (term.exponent == 0.0) {
      fail(what, "an exponent is 0", "give one that is not, for instance alpha = 2");
    }
  }
  for (const double w : polynomial) {
    if (!std::isfinite(w)) fail(what, "a coefficient is not finite", "give finite numbers");
  }
  const double mu = shear_modulus();
  if (!(mu > 0.0) || !std::isfinite(mu)) {
    fail(what, fmt::format("its initial shear modulus is {:g} Pa", mu),
         "check the coefficients' signs, units, and the convention that they are published in");
  }
  if (!(bulk_modulus > 0.0) || !std::isfinite(bulk_modulus)) {
    fail(what, fmt::format("its bulk modulus is {:g} Pa", bulk_modulus),
         "give a bulk modulus above 0, or a Poisson's ratio below 0.5");
  }
  if (mullins) {
    const bool finite =
        std::isfinite(mullins->r) && std::isfinite(mullins->m) && std::isfinite(mullins->beta);
    if (!finite || !(mullins->r > 1.0) || !(mullins->m >= 0.0) || !(mullins->beta >= 0.0) ||
        !(mullins->m + mullins->beta > 0.0)) {
      fail(what,
           fmt::format("its softening has r = {:g}, m = {:g} Pa, beta = {:g}", mullins->r,
                       mullins->m, mullins->beta),
           "give r above 1, and m and beta not below 0 and not both 0");
    }
  }
  for (const PronyTerm& term : prony) {
    if (!(term.relative_modulus > 0.0) || !(term.relaxation_time > 0.0) ||
        !std::isfinite(term.relaxation_time)) {
      fail(what,
           fmt::format("a part of its Prony series has the relative modulus {:g} and relaxes in "
                       "{:g} s",
                       term.relative_modulus, term.relaxation_time),
           "give numbers above 0");
    }
  }
  if (!(long_term_share() > 0.0)) {
    fail(what,
         fmt::format("the relative moduli of its Prony series add up to {:g}",
                     1.0 - long_term_share()),
         "let them stay below 1: what is left is the stiffness of slow motion");
  }
}

Hyperelastic relaxed(Hyperelastic law) {
  const double share = law.long_term_share();
  for (PowerTerm& term : law.powers) term.coefficient *= share;
  for (double& coefficient : law.polynomial) coefficient *= share;
  if (law.saint_venant_shear > 0.0) {  // all of its stress relaxes
    law.saint_venant_shear *= share;
    law.bulk_modulus *= share;
  }
  return law;
}

double bulk_modulus_of(double shear, double poisson_ratio) {
  return 2.0 * shear * (1.0 + poisson_ratio) / (3.0 * (1.0 - 2.0 * poisson_ratio));
}

Hyperelastic neo_hookean(double shear_modulus) {
  return {.powers = {{0.5 * shear_modulus, 2.0}}, .polynomial = {}};
}

Hyperelastic mooney_rivlin(double c10, double c01) {
  return {.powers = {{c10, 2.0}, {c01, -2.0}}, .polynomial = {}};
}

Hyperelastic yeoh(const std::vector<double>& coefficients) {
  return {.powers = {}, .polynomial = coefficients};
}

Hyperelastic ogden(const std::vector<OgdenTerm>& terms, OgdenConvention convention) {
  Hyperelastic result;
  for (const OgdenTerm& term : convert(terms, convention, OgdenConvention::mu_over_alpha)) {
    result.powers.push_back({term.modulus / term.alpha, term.alpha});
  }
  return result;
}

// mu sum_k C_k / m^(2k-2) (I^k - 3^k), with I = 3 + x and I^k = sum_j binomial(k, j) 3^(k-j) x^j.
Hyperelastic arruda_boyce(double shear_modulus, double locking_stretch) {
  constexpr std::array<double, 5> kSeries = {1.0 / 2.0, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0,
                                             519.0 / 673750.0};
  Hyperelastic result;
  result.polynomial.assign(kSeries.size(), 0.0);
  for (std::size_t k = 1; k <= kSeries.size(); ++k) {
    const double factor = shear_modulus * kSeries[k - 1] /
                          std::pow(locking_stretch, 2.0 * static_cast<double>(k - 1));
    double binomial = 1.0;
    for (std::size_t j = 1; j <= k; ++j) {
      binomial *= static_cast<double>(k - j + 1) / static_cast<double>(j);
      result.polynomial[j - 1] += factor * binomial * std::pow(3.0, static_cast<double>(k - j));
    }
  }
  return result;
}

Hyperelastic saint_venant_kirchhoff(double young_modulus, double poisson_ratio) {
  Hyperelastic result;
  result.saint_venant_shear = young_modulus / (2.0 * (1.0 + poisson_ratio));
  result.bulk_modulus = young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio));
  return result;
}

std::vector<OgdenTerm> convert(const std::vector<OgdenTerm>& terms, OgdenConvention from,
                               OgdenConvention to) {
  std::vector<OgdenTerm> result = terms;
  if (from == to) return result;
  // mu_1 / alpha = 2 mu_2 / alpha^2
  for (OgdenTerm& term : result) {
    const double ratio = 2.0 / term.alpha;
    term.modulus *= to == OgdenConvention::mu_over_alpha ? ratio : 1.0 / ratio;
  }
  return result;
}

// Uses the functions of the kernels, in one lane.
LogResponse respond(const Hyperelastic& law, const std::array<double, 3>& stretches,
                    bool volumetric) {
  Principal at;
  at.determinant = lanes(stretches[0] * stretches[1] * stretches[2]);
  for (int i = 0; i < 3; ++i) at.stretch[i] = lanes(stretches[static_cast<std::size_t>(i)]);
  LanesLogResponse response = respond(law, at);
  // Saint Venant-Kirchhoff has no separate volumetric part.
  if (volumetric && law.saint_venant_shear == 0.0) {
    add_volumetric(response, at.determinant, law.bulk_modulus);
  }
  LogResponse result;
  result.energy = response.energy[0];
  for (std::size_t i = 0; i < 3; ++i) {
    result.first[i] = response.first[i][0];
    for (std::size_t j = 0; j <= i; ++j) {
      result.second[i][j] = result.second[j][i] = response.second[i][j][0];
    }
  }
  return result;
}

std::array<double, 3> incompressible_stretches(DeformationMode mode, double stretch) {
  switch (mode) {
    case DeformationMode::uniaxial:
      return {stretch, 1.0 / std::sqrt(stretch), 1.0 / std::sqrt(stretch)};
    case DeformationMode::equibiaxial:
      return {stretch, stretch, 1.0 / (stretch * stretch)};
    case DeformationMode::planar:
      return {stretch, 1.0, 1.0 / stretch};
  }
  return {1.0, 1.0, 1.0};
}

double nominal_stress(const Hyperelastic& law, DeformationMode mode, double stretch) {
  // The last face is unloaded: its Kirchhoff stress is the pressure to subtract.
  const LogResponse response = respond(law, incompressible_stretches(mode, stretch), false);
  return (response.first[0] - response.first[2]) / stretch;
}

namespace {

// Whether the second derivative is positive definite on isochoric motions e_3 = -e_1 - e_2.
bool is_stable(const Hyperelastic& law, DeformationMode mode, double stretch) {
  const auto h = respond(law, incompressible_stretches(mode, stretch), false).second;
  const double a = h[0][0] - 2.0 * h[0][2] + h[2][2];
  const double b = h[1][1] - 2.0 * h[1][2] + h[2][2];
  const double c = h[0][1] - h[0][2] - h[1][2] + h[2][2];
  return a > 0.0 && a * b - c * c > 0.0;
}

// The stretch between 1 and `end` at which stability ends, by equal ratios and then by bisection.
double end_of_stability(const Hyperelastic& law, DeformationMode mode, double end) {
  constexpr int kSamples = 400, kBisections = 50;
  double stable = 1.0;
  for (int k = 1; k <= kSamples; ++k) {
    double next = std::pow(end, static_cast<double>(k) / kSamples);
    if (is_stable(law, mode, next)) {
      stable = next;
      continue;
    }
    for (int j = 0; j < kBisections; ++j) {
      const double middle = 0.5 * (stable + next);
      (is_stable(law, mode, middle) ? stable : next) = middle;
    }
    return stable;
  }
  return end;
}

}  // namespace

std::pair<double, double> stable_range(const Hyperelastic& law, DeformationMode mode, double lowest,
                                       double highest) {
  if (!is_stable(law, mode, 1.0)) return {1.0, 1.0};
  return {end_of_stability(law, mode, lowest), end_of_stability(law, mode, highest)};
}

}  // namespace sinew::material
