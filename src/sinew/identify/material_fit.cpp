#include "sinew/identify/material_fit.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/identify/material_search.hpp"

namespace sinew::identify {

namespace {

constexpr double kMinCost = 1e-12;  // a relative RMS of 1e-6

void check(const FitSettings& settings) {
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

TestFit test_fit(const FitResult& fit, const CountedTest& test) {
  const RubberTest& rows = *test.test;
  TestFit result;
  result.rows = test.rows;
  for (std::size_t i = 0; i < rows.stretch.size(); ++i) {
    result.stress.push_back(material::nominal_stress(fit.energy, rows.mode, rows.stretch[i]));
  }
  if (fit.mullins) result.stress = predict(fit.energy, &*fit.mullins, test);
  double squares = 0.0, products = 0.0, before = 0.0;
  for (std::size_t i = 0; i < rows.stretch.size(); ++i) {
    if (test.counts[i] == 0) continue;
    const double residual = result.stress[i] - rows.stress[i];
    squares += residual * residual;
    products += residual * before;
    before = residual;
  }
  result.rms = std::sqrt(squares / static_cast<double>(test.rows));
  result.relative = result.rms / test.largest;
  result.correlation = squares > 0.0 ? products / squares : 0.0;
  return result;
}

FitResult result_of(const std::string& model, MaterialSearch& search,
                    std::span<const CountedTest> tests, const FitSettings& settings) {
  const Attempt& best = search.best(model);
  FittedLaw law = fitted_law(model);
  if (law.ogden) law = ogden_law(best.law.size() / 2);
  std::vector<double> values;
  for (const FitParameter& p : best.law) values.push_back(p.value);
  FitResult result;
  result.model = model;
  result.cost = best.cost / static_cast<double>(tests.size());
  result.converged = best.converged;
  result.coefficients = law.tell(values.data(), search.scale());
  result.energy = law.build(values.data(), search.scale());
  result.energy.bulk_modulus =
      material::bulk_modulus_of(result.energy.shear_modulus(), settings.poisson_ratio);
  if (settings.mullins) result.mullins = softening_of(best.softening, search.scale());
  for (const CountedTest& test : tests) result.tests.push_back(test_fit(result, test));
  using material::DeformationMode;
  result.uniaxial_range = material::stable_range(result.energy, DeformationMode::uniaxial);
  result.equibiaxial_range = material::stable_range(result.energy, DeformationMode::equibiaxial);
  result.planar_range = material::stable_range(result.energy, DeformationMode::planar);
  return result;
}

}  // namespace

std::vector<std::string> fit_models() {
  return {"neo-hookean", "mooney-rivlin", "yeoh1",  "yeoh2",  "yeoh3",  "arruda-boyce",
          "ogden1",      "ogden2",        "ogden3", "ogden4", "ogden5", "ogden6"};
}

std::vector<FitResult> fit_materials(
    std::span<const RubberTest> tests, std::span<const std::string> models,
    const FitSettings& settings,
    const std::function<void(int done, int all, const std::string& model)>& progress) {
  check(settings);
  const std::vector<CountedTest> counted = count_rows(tests, settings);
  const int all = MaterialSearch::starts(models, settings);
  int done = 0;
  MaterialSearch search(counted, settings, [&](const std::string& model) {
    ++done;
    if (progress) progress(done, all, model);
  });
  std::vector<FitResult> results;
  for (const std::string& model : models) {
    results.push_back(result_of(model, search, counted, settings));
  }
  return results;
}

FitResult fit_material(std::span<const RubberTest> tests, const FitSettings& settings) {
  return fit_materials(tests, {&settings.model, 1}, settings).front();
}

std::vector<double> bayes_information(std::span<const FitResult> fits) {
  const FitResult& closest = *std::ranges::min_element(fits, {}, &FitResult::cost);
  double worth = 0.0;
  for (const TestFit& test : closest.tests) {
    const double rows = static_cast<double>(test.rows), r = test.correlation;
    worth += std::clamp(rows * (1.0 - r) / (1.0 + r), 2.0, rows);
  }
  std::vector<double> result;
  for (const FitResult& fit : fits) {
    result.push_back(worth * std::log(std::max(fit.cost, kMinCost)) +
                     fit.parameters() * std::log(worth));
  }
  return result;
}

std::string material_yaml(const FitResult& fit, std::span<const RubberTest> tests,
                          const FitSettings& settings) {
  std::string text = fmt::format("# {} fitted by sinew fit to", fit.model);
  for (std::size_t k = 0; k < tests.size(); ++k) {
    text += fmt::format("{} {} ({}, RMS {:.2g} % of its largest stress)", k == 0 ? "" : ",",
                        tests[k].name, mode_name(tests[k].mode), 100.0 * fit.tests[k].relative);
  }
  if (settings.min_stretch > 0.0 || std::isfinite(settings.max_stretch)) {
    text += fmt::format("\n# Rows of a stretch from {:g} to {:g}.", settings.min_stretch,
                        settings.max_stretch);
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
  return text + fmt::format("poisson_ratio: {}\n", settings.poisson_ratio);
}

}  // namespace sinew::identify
