#include "sinew/identify/material_residuals.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"

namespace sinew::identify {

std::vector<CountedTest> count_rows(std::span<const RubberTest> tests,
                                    const FitSettings& settings) {
  if (tests.empty()) {
    throw Error(ErrorKind::empty_list, {.item = "tests"}, "there is no test", "give a table");
  }
  if (!(settings.min_stretch < settings.max_stretch)) {
    throw Error(ErrorKind::contradictory_limits, {.item = "stretch"},
                fmt::format("no stretch lies between {:g} and {:g}", settings.min_stretch,
                            settings.max_stretch),
                "give the smaller one first, for instance 1 and 4");
  }
  std::vector<CountedTest> result;
  for (const RubberTest& test : tests) {
    CountedTest& counted = result.emplace_back();
    counted.test = &test;
    for (std::size_t i = 0; i < test.stretch.size(); ++i) {
      const double stretch = test.stretch[i];
      const bool counts = stretch >= settings.min_stretch && stretch <= settings.max_stretch;
      counted.counts.push_back(counts ? 1 : 0);
      if (!counts) continue;
      ++counted.rows;
      counted.largest = std::max(counted.largest, std::abs(test.stress[i]));
      counted.farthest = std::max(counted.farthest, std::abs(std::log(stretch)));
    }
    if (counted.rows < 3) {
      throw Error(ErrorKind::too_few_points, {.item = test.name},
                  fmt::format("{} rows lie at a stretch of {:g} to {:g}", counted.rows,
                              settings.min_stretch, settings.max_stretch),
                  "a fit needs three or more; widen the range");
    }
    if (counted.largest > 0.0) continue;
    throw Error(ErrorKind::out_of_range, {.item = test.name}, "every stress is zero",
                "give a test with a load");
  }
  return result;
}

MullinsEffect softening_of(const FitParameters& softening, double scale) {
  return {1.0 / softening[0].value, scale * softening[1].value, softening[2].value};
}

std::vector<double> predict(const material::Hyperelastic& law, const MullinsEffect* mullins,
                            const CountedTest& test) {
  const RubberTest& rows = *test.test;
  std::vector<double> result(rows.stretch.size(), 0.0);
  double most = 0.0;
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (test.counts[i] == 0 && mullins == nullptr) continue;
    const double stretch = rows.stretch[i];
    result[i] = material::nominal_stress(law, rows.mode, stretch);
    if (mullins == nullptr) continue;
    const auto stretches = material::incompressible_stretches(rows.mode, stretch);
    const double energy = material::respond(law, stretches, false).energy;
    most = std::max(most, energy);
    const double width = mullins->m + mullins->beta * most + 1e-12;
    result[i] *= 1.0 - std::erf((most - energy) / width) / mullins->r;
  }
  return result;
}

bool Residuals::operator()(const double* parameters, double* residuals) const {
  FitParameters softening;
  for (std::size_t k = 0; mullins && k < 3; ++k) softening.push_back({parameters[own + k]});
  const material::Hyperelastic energy = law->build(parameters, scale);
  MullinsEffect effect;
  if (mullins) effect = softening_of(softening, scale);
  std::size_t at = 0;
  for (const CountedTest& test : *tests) {
    const double weight = 1.0 / (test.largest * std::sqrt(static_cast<double>(test.rows)));
    const std::vector<double> found = predict(energy, mullins ? &effect : nullptr, test);
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (test.counts[i] == 0) continue;
      residuals[at] = weight * (found[i] - test.test->stress[i]);
      if (!std::isfinite(residuals[at++])) return false;
    }
  }
  return true;
}

bool OgdenResiduals::operator()(const double* parameters, double* residuals,
                                double* derivatives) const {
  std::size_t row = 0;
  for (const CountedTest& test : *tests) {
    const double weight = 1.0 / (test.largest * std::sqrt(static_cast<double>(test.rows)));
    for (std::size_t i = 0; i < test.counts.size(); ++i) {
      if (test.counts[i] == 0) continue;
      double sum = -weight * test.test->stress[i];
      double* slopes = derivatives == nullptr ? nullptr : derivatives + 2 * terms * row;
      for (std::size_t k = 0; k < terms; ++k) {
        const double share = parameters[2 * k], alpha = parameters[2 * k + 1];
        const TermStress unit = term_stress(test.test->mode, test.test->stretch[i], alpha);
        const double by_share = weight * scale * unit.value;
        sum += share * by_share;
        if (slopes == nullptr) continue;
        slopes[2 * k] = by_share;
        slopes[2 * k + 1] = share * weight * scale * unit.by_alpha;
      }
      residuals[row++] = sum;
      if (!std::isfinite(sum)) return false;
    }
  }
  return true;
}

}  // namespace sinew::identify
