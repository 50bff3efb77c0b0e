#include "sinew/identify/fitted_law.hpp"

#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/core/types.hpp"

namespace sinew::identify {

namespace {

using Random = std::mt19937_64;

constexpr double kSmallestModulus = 1e-6;  // relative to the scale, if a law needs a positive one

FitParameter modulus(double value, double lower = -kInfinity) {
  return {value, lower, kInfinity, true};
}

FittedLaw neo_hookean(const std::string& model) {
  return {model,
          true,
          false,
          [](Random&) { return FitParameters{modulus(1.0, kSmallestModulus)}; },
          [](const double* p, double s) { return material::neo_hookean(s * p[0]); },
          [](const double* p, double s) {
            return std::vector<Coefficient>{{"shear_modulus", s * p[0], "Pa"}};
          }};
}

FittedLaw mooney_rivlin(const std::string& model) {
  return {model,
          true,
          false,
          [](Random&) {
            return FitParameters{modulus(0.4, 0.0), modulus(0.1, 0.0)};
          },
          [](const double* p, double s) { return material::mooney_rivlin(s * p[0], s * p[1]); },
          [](const double* p, double s) {
            return std::vector<Coefficient>{{"c10", s * p[0], "Pa"}, {"c01", s * p[1], "Pa"}};
          }};
}

FittedLaw yeoh(const std::string& model, std::size_t terms) {
  return {model,
          true,
          false,
          [terms](Random&) {
            FitParameters result(terms, modulus(0.0));
            result.front() = modulus(0.5, kSmallestModulus);
            return result;
          },
          [terms](const double* p, double s) {
            std::vector<double> c(p, p + terms);
            for (double& value : c) value *= s;
            return material::yeoh(c);
          },
          [terms](const double* p, double s) {
            std::vector<Coefficient> result;
            for (std::size_t k = 0; k < terms; ++k) {
              result.push_back({fmt::format("c{}0", k + 1), s * p[k], "Pa"});
            }
            return result;
          }};
}

std::vector<material::OgdenTerm> ogden_terms(const double* p, double s, std::size_t terms) {
  std::vector<material::OgdenTerm> result;
  for (std::size_t k = 0; k < terms; ++k) {
    result.push_back({2.0 * s * p[2 * k] / p[2 * k + 1], p[2 * k + 1]});
  }
  return result;
}

FitParameters draw_ogden(Random& random, std::size_t terms) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  FitParameters result;
  for (std::size_t k = 0; k < terms; ++k) {
    // The first exponent is positive; the others have either sign.
    const bool positive = k == 0 || uniform(random) < 0.6;
    const double size = 0.5 + 9.5 * std::pow(uniform(random), 2.0);
    const double share = std::pow(10.0, -3.0 * uniform(random));
    const FitParameters term = ogden_term(share, positive ? size : -size);
    result.insert(result.end(), term.begin(), term.end());
  }
  return result;
}

FittedLaw arruda_boyce(const std::string& model) {
  return {model,
          false,
          false,
          [](Random& random) {
            std::uniform_real_distribution<double> uniform(0.0, 1.0);
            return FitParameters{modulus(1.0, kSmallestModulus),
                                 {1.5 + 6.0 * uniform(random), 1.05, 100.0}};
          },
          [](const double* p, double s) { return material::arruda_boyce(s * p[0], p[1]); },
          [](const double* p, double s) {
            return std::vector<Coefficient>{{"shear_modulus", s * p[0], "Pa"},
                                            {"locking_stretch", p[1], ""}};
          }};
}

/// Splits "ogden3" into "ogden" and 3; a name without a digit has 0.
std::pair<std::string, std::size_t> split(const std::string& model) {
  if (model.empty() || model.back() < '1' || model.back() > '9') return {model, 0};
  return {model.substr(0, model.size() - 1), static_cast<std::size_t>(model.back() - '0')};
}

}  // namespace

FitParameters ogden_term(double share, double alpha) {
  const bool positive = alpha > 0.0;
  return {modulus(share, 0.0),
          {alpha, positive ? kSmallestExponent : -kLargestExponent,
           positive ? kLargestExponent : -kSmallestExponent}};
}

FittedLaw ogden_law(std::size_t terms) {
  return {fmt::format("ogden{}", terms),
          false,
          true,
          [terms](Random& random) { return draw_ogden(random, terms); },
          [terms](const double* p, double s) {
            return material::ogden(ogden_terms(p, s, terms),
                                   material::OgdenConvention::mu_over_alpha);
          },
          [terms](const double* p, double s) {
            std::vector<Coefficient> result;
            for (const auto& term : ogden_terms(p, s, terms)) {
              result.push_back({"mu", term.modulus, "Pa"});
              result.push_back({"alpha", term.alpha, ""});
            }
            return result;
          }};
}

FittedLaw fitted_law(const std::string& model) {
  if (model == "neo-hookean") return neo_hookean(model);
  if (model == "mooney-rivlin") return mooney_rivlin(model);
  if (model == "arruda-boyce") return arruda_boyce(model);
  const auto [family, terms] = split(model);
  if (family == "yeoh" && terms >= 1 && terms <= 3) return yeoh(model, terms);
  if (family == "ogden" && terms >= 1 && terms <= 6) return ogden_law(terms);
  const std::vector<std::string> models = fit_models();
  const std::string near = nearest_word(model, models);
  throw Error(ErrorKind::unknown_choice, {.item = "model"},
              fmt::format("there is no model '{}'", model),
              fmt::format("{}the models are {}; the digit is the number of terms",
                          near.empty() ? "" : fmt::format("did you mean '{}'? ", near),
                          fmt::join(models, ", ")));
}

TermStress term_stress(material::DeformationMode mode, double stretch, double alpha) {
  const auto stretches = material::incompressible_stretches(mode, stretch);
  const double first = std::pow(stretches[0], alpha), third = std::pow(stretches[2], alpha);
  const double value = 2.0 / alpha * (first - third) / stretch;
  const double slope =
      2.0 / alpha / stretch * (first * std::log(stretches[0]) - third * std::log(stretches[2]));
  return {value, slope - value / alpha};
}

std::string contained_model(const std::string& model) {
  const auto [family, terms] = split(model);
  if (model == "mooney-rivlin" || model == "yeoh1" || model == "ogden1") return "neo-hookean";
  return terms > 1 ? fmt::format("{}{}", family, terms - 1) : "";
}

FitParameters embedded(const std::string& model, const FitParameters& contained) {
  const auto [family, terms] = split(model);
  if (model == "ogden1") return ogden_term(contained[0].value, 2.0);  // mu/2 (I - 3)
  FitParameters result = contained;
  if (model == "mooney-rivlin" || model == "yeoh1") result[0].value *= 0.5;  // C10 = mu/2
  if (model == "mooney-rivlin") result = {modulus(result[0].value, 0.0), modulus(0.0, 0.0)};
  if (family == "yeoh" && terms > 1) result.push_back(modulus(0.0));
  return result;
}

}  // namespace sinew::identify
