#include "sinew/identify/material_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/identify/bounded_least_squares.hpp"

namespace sinew::identify {

namespace {

using material::Hyperelastic;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargestExponent = 30.0, kSmallestExponent = 0.1;

/// One number that is fitted. Moduli are in units of the tests' scale.
struct Parameter {
  double start = 1.0, lower = -kInfinity, upper = kInfinity;
};

/// A law as a function of its parameters.
struct Form {
  bool linear = false;  // one start will do
  std::function<std::vector<Parameter>(std::mt19937_64&)> draw;
  std::function<Hyperelastic(const double*, double)> build;  // parameters, scale (Pa)
  std::function<std::vector<Coefficient>(const double*, double)> tell;
};

Form neo_hookean() {
  return {true,
          [](auto&) {
            return std::vector<Parameter>{{1.0, 1e-6}};
          },
          [](const double* p, double s) { return material::neo_hookean(s * p[0]); },
          [](const double* p, double s) {
            return std::vector<Coefficient>{{"shear_modulus", s * p[0], "Pa"}};
          }};
}

Form mooney_rivlin() {
  return {true,
          [](auto&) {
            return std::vector<Parameter>{{0.4, 0.0}, {0.1, 0.0}};
          },
          [](const double* p, double s) { return material::mooney_rivlin(s * p[0], s * p[1]); },
          [](const double* p, double s) {
            return std::vector<Coefficient>{{"c10", s * p[0], "Pa"}, {"c01", s * p[1], "Pa"}};
          }};
}

Form yeoh(std::size_t terms) {
  return {true,
          [terms](auto&) {
            std::vector<Parameter> result(terms, {0.0});
            result.front() = {0.5, 1e-6};
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

// Parameters: each term's share mu alpha / 2 of the initial shear modulus, and alpha.
std::vector<material::OgdenTerm> ogden_terms(const double* p, double s, std::size_t terms) {
  std::vector<material::OgdenTerm> result;
  for (std::size_t k = 0; k < terms; ++k) {
    result.push_back({2.0 * s * p[2 * k] / p[2 * k + 1], p[2 * k + 1]});
  }
  return result;
}

Form ogden(std::size_t terms) {
  return {false,
          [terms](std::mt19937_64& random) {
            std::uniform_real_distribution<double> uniform(0.0, 1.0);
            std::vector<Parameter> result;
            for (std::size_t k = 0; k < terms; ++k) {
              // The first term stretches, others either way.
              const bool positive = k == 0 || uniform(random) < 0.6;
              const double size = 0.5 + 9.5 * std::pow(uniform(random), 2.0);
              const double share = std::pow(10.0, -3.0 * uniform(random));
              result.push_back({share, 0.0});
              result.push_back(positive ? Parameter{size, kSmallestExponent, kLargestExponent}
                                        : Parameter{-size, -kLargestExponent, -kSmallestExponent});
            }
            return result;
          },
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

Form arruda_boyce() {
  return {false,
          [](std::mt19937_64& random) {
            std::uniform_real_distribution<double> uniform(0.0, 1.0);
            return std::vector<Parameter>{{1.0, 1e-6}, {1.5 + 6.0 * uniform(random), 1.05, 100.0}};
          },
          [](const double* p, double s) { return material::arruda_boyce(s * p[0], p[1]); },
          [](const double* p, double s) {
            return std::vector<Coefficient>{{"shear_modulus", s * p[0], "Pa"},
                                            {"locking_stretch", p[1], ""}};
          }};
}

Form form_of(const std::string& model) {
  if (model == "neo-hookean") return neo_hookean();
  if (model == "mooney-rivlin") return mooney_rivlin();
  if (model == "arruda-boyce") return arruda_boyce();
  const auto terms = static_cast<std::size_t>(model.empty() ? 0 : model.back() - '0');
  const std::string family = model.substr(0, model.empty() ? 0 : model.size() - 1);
  if (family == "yeoh" && terms >= 1 && terms <= 3) return yeoh(terms);
  if (family == "ogden" && terms >= 1 && terms <= 6) return ogden(terms);
  const std::vector<std::string> models = fit_models();
  const std::string near = nearest_word(model, models);
  throw Error(ErrorKind::unknown_choice, {.item = "model"},
              fmt::format("there is no model '{}'", model),
              near.empty() ? fmt::format("take one of {}", fmt::join(models, ", "))
                           : fmt::format("did you mean '{}'?", near));
}

/// Stress along a test, with softening where asked.
std::vector<double> stresses(const Hyperelastic& law, const MullinsEffect* mullins,
                             const RubberTest& test) {
  std::vector<double> result;
  double most = 0.0;
  for (const double stretch : test.stretch) {
    double stress = material::nominal_stress(law, test.mode, stretch);
    if (mullins != nullptr) {
      const double energy =
          material::respond(law, material::incompressible_stretches(test.mode, stretch), false)
              .energy;
      most = std::max(most, energy);
      const double width = mullins->m + mullins->beta * most + 1e-12;
      stress *= 1.0 - std::erf((most - energy) / width) / mullins->r;
    }
    result.push_back(stress);
  }
  return result;
}

constexpr std::size_t kMullinsParameters = 3;

MullinsEffect mullins_of(const double* p, double scale) { return {1.0 / p[0], scale * p[1], p[2]}; }

/// Residuals of all tests over all parameters.
struct Residuals {
  const Form* form;
  std::span<const RubberTest> tests;
  double scale;
  std::size_t own;  // parameters of the law; the softening's follow
  bool mullins;

  bool operator()(const double* p, double* residuals) const {
    const Hyperelastic law = form->build(p, scale);
    MullinsEffect softening;
    if (mullins) softening = mullins_of(p + own, scale);
    std::size_t at = 0;
    for (const RubberTest& test : tests) {
      const double weight =
          1.0 / (test.largest_stress() * std::sqrt(static_cast<double>(test.stretch.size())));
      const std::vector<double> found = stresses(law, mullins ? &softening : nullptr, test);
      for (std::size_t i = 0; i < found.size(); ++i, ++at) {
        residuals[at] = weight * (found[i] - test.stress[i]);
        if (!std::isfinite(residuals[at])) return false;
      }
    }
    return true;
  }
};

struct Attempt {
  std::vector<double> parameters;
  double cost = kInfinity;
  bool converged = false;
};

Attempt solve(const Residuals& residuals, std::vector<Parameter> start) {
  if (residuals.mullins) {
    start.insert(start.end(), {{0.5, 0.0, 0.999}, {0.3, 0.0, 1e3}, {0.1, 0.0, 1e2}});
  }
  std::vector<BoundedValue> values;
  values.reserve(start.size());
  for (const Parameter& p : start) values.push_back({p.start, p.lower, p.upper});
  std::size_t rows = 0;
  for (const RubberTest& test : residuals.tests) rows += test.stretch.size();
  const BoundedResult found =
      solve_bounded_by_differences(residuals, rows, values, {.max_iterations = 400});
  Attempt attempt;
  for (const BoundedValue& value : values) attempt.parameters.push_back(value.value);
  attempt.converged = found.converged;
  if (found.usable) attempt.cost = found.cost;
  return attempt;
}

void check(std::span<const RubberTest> tests, const FitSettings& settings) {
  if (tests.empty()) {
    throw Error(ErrorKind::empty_list, {.item = "tests"}, "there is no test", "give a table");
  }
  for (const RubberTest& test : tests) {
    if (test.largest_stress() > 0.0) continue;
    throw Error(ErrorKind::out_of_range, {.item = test.name}, "every stress is zero",
                "give a test with a load");
  }
  if (settings.starts < 1) {
    throw Error(ErrorKind::out_of_range, {.item = "starts"},
                fmt::format("there are {} starts", settings.starts), "give one or more");
  }
  if (!(settings.poisson_ratio > -1.0 && settings.poisson_ratio < 0.5)) {
    throw Error(ErrorKind::out_of_range, {.item = "poisson_ratio"},
                fmt::format("Poisson's ratio is {:g}", settings.poisson_ratio),
                "give one below 0.5, for instance 0.49");
  }
}

}  // namespace

std::vector<std::string> fit_models() {
  return {"neo-hookean", "mooney-rivlin", "yeoh1",  "yeoh2",  "yeoh3",  "arruda-boyce",
          "ogden1",      "ogden2",        "ogden3", "ogden4", "ogden5", "ogden6"};
}

FitResult fit_material(std::span<const RubberTest> tests, const FitSettings& settings) {
  check(tests, settings);
  const Form form = form_of(settings.model);
  // The scale of moduli: the mean secant modulus of the tests at half their stretch, over three.
  double scale = 0.0;
  for (const RubberTest& test : tests) {
    double far = 0.0;
    for (const double stretch : test.stretch) far = std::max(far, std::abs(std::log(stretch)));
    scale += test.largest_stress() / std::max(far, 1e-3) / 3.0 / static_cast<double>(tests.size());
  }
  std::mt19937_64 random(settings.seed);
  FitResult result;
  result.model = settings.model;
  Attempt best;
  const int starts = form.linear && !settings.mullins ? 1 : settings.starts;
  std::size_t own = 0;
  for (int k = 0; k < starts; ++k) {
    const std::vector<Parameter> start = form.draw(random);
    own = start.size();
    const Attempt found = solve({&form, tests, scale, own, settings.mullins}, start);
    if (found.cost < best.cost) {
      best = found;
      result.best_start = k;
    }
  }
  if (best.parameters.empty()) {
    throw Error(ErrorKind::not_converged, {.item = settings.model}, "no start led to a usable fit",
                "try more starts, or a simpler model");
  }
  result.cost = best.cost / static_cast<double>(tests.size());
  result.converged = best.converged;
  result.coefficients = form.tell(best.parameters.data(), scale);
  result.energy = form.build(best.parameters.data(), scale);
  result.energy.bulk_modulus =
      material::bulk_modulus_of(result.energy.shear_modulus(), settings.poisson_ratio);
  if (settings.mullins) result.mullins = mullins_of(best.parameters.data() + own, scale);
  for (const RubberTest& test : tests) {
    TestFit& fit = result.tests.emplace_back();
    fit.stress = stresses(result.energy, result.mullins ? &*result.mullins : nullptr, test);
    double sum = 0.0;
    for (std::size_t i = 0; i < fit.stress.size(); ++i) {
      sum += std::pow(fit.stress[i] - test.stress[i], 2);
    }
    fit.rms = std::sqrt(sum / static_cast<double>(fit.stress.size()));
    fit.relative = fit.rms / test.largest_stress();
  }
  using material::DeformationMode;
  result.uniaxial_range = material::stable_range(result.energy, DeformationMode::uniaxial);
  result.equibiaxial_range = material::stable_range(result.energy, DeformationMode::equibiaxial);
  result.planar_range = material::stable_range(result.energy, DeformationMode::planar);
  return result;
}

std::string material_yaml(const FitResult& fit, std::span<const RubberTest> tests,
                          double poisson_ratio) {
  std::string text = fmt::format("# {} fitted by sinew fit to", fit.model);
  for (std::size_t k = 0; k < tests.size(); ++k) {
    text += fmt::format("{} {} ({}, RMS {:.2g} % of its largest stress)", k == 0 ? "" : ",",
                        tests[k].name, mode_name(tests[k].mode), 100.0 * fit.tests[k].relative);
  }
  text += fmt::format("\n# Stable in uniaxial stretches from {:.3g} to {:.3g}.\n",
                      fit.uniaxial_range.first, fit.uniaxial_range.second);
  const bool ogden = fit.model.starts_with("ogden"), yeoh = fit.model.starts_with("yeoh");
  text += fmt::format("model: {}\n", ogden ? "ogden" : yeoh ? "yeoh" : fit.model);
  if (ogden) {
    std::string moduli, exponents;
    for (const Coefficient& c : fit.coefficients) {
      (c.name == "mu" ? moduli : exponents) += fmt::format(" {}", c.value);
    }
    text += fmt::format("mu:{} Pa\nalpha:{}\nconvention: mu-over-alpha\n", moduli, exponents);
  } else {
    for (const Coefficient& c : fit.coefficients) {
      text += fmt::format("{}: {}{}{}\n", c.name, c.value, *c.unit != '\0' ? " " : "", c.unit);
    }
  }
  if (fit.mullins) {
    text += fmt::format("softening: {{r: {:.6g}, m: {:.6g} Pa, beta: {:.6g}}}\n", fit.mullins->r,
                        fit.mullins->m, fit.mullins->beta);
  }
  return text + fmt::format("poisson_ratio: {}\n", poisson_ratio);
}

}  // namespace sinew::identify
