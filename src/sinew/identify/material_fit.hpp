/// @file
/// Coefficients of hyperelastic laws from tests, by bounded least squares.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sinew/identify/rubber_test.hpp"

namespace sinew::identify {

using material::MullinsEffect;

struct FitSettings {
  /// "neo-hookean", "mooney-rivlin", "yeoh1" to "yeoh3", "ogden1" to "ogden6", "arruda-boyce".
  std::string model = "ogden3";
  int starts = 5;  ///< random ones, for laws that are not linear in their coefficients
  std::uint64_t seed = 1;
  bool mullins = false;
  double poisson_ratio = 0.49;  ///< of the material that is written; tests are taken incompressible
  /// Rows outside do not count; softening knows of them.
  double min_stretch = 0.0, max_stretch = std::numeric_limits<double>::infinity();
};

/// One coefficient by the name that scenes use.
struct Coefficient {
  std::string name;
  double value = 0.0;
  const char* unit = "";
};

/// How well a law meets one test.
struct TestFit {
  std::size_t rows = 0;        ///< that count; the next three are of them
  double rms = 0.0;            ///< Pa
  double relative = 0.0;       ///< over the test's largest stress
  double correlation = 0.0;    ///< of a row's residual with that of the row before, -1 to 1
  std::vector<double> stress;  ///< nominal, Pa, at all of the test's stretches
};

struct FitResult {
  std::string model;
  /// Of Ogden's law those of distinct terms that bear something: perhaps fewer than asked for.
  std::vector<Coefficient> coefficients;
  material::Hyperelastic energy;  ///< with the bulk modulus of the settings' Poisson's ratio
  std::optional<MullinsEffect> mullins;
  std::vector<TestFit> tests;  ///< as given
  double cost = 0.0;           ///< mean over tests of their relative RMS squared
  /// Stretches between which the law is stable after Drucker, in tension and pressure, equibiaxial
  /// and planar; within 0.1 to 10.
  std::pair<double, double> uniaxial_range, equibiaxial_range, planar_range;
  bool converged = false;

  /// Numbers that were fitted, those of softening included.
  int parameters() const { return static_cast<int>(coefficients.size()) + (mullins ? 3 : 0); }
};

/// Names of all models.
std::vector<std::string> fit_models();

/// Minimises sum over tests of mean((P - P_measured)^2)/max(P_measured)^2, so that every test
/// counts the same. Ogden's terms keep mu alpha >= 0, which makes each of them stable; exponents
/// stay within 30. Trust region with bounds (Ceres), from random starts that a seed determines and
/// from the solution of the model that this one contains (of Ogden's with one term less, to which a
/// term is added where it lessens the cost most): a richer model of a family never fits worse.
/// Throws Error: empty-list (no tests), unknown-choice (model), out-of-range (starts, ratio, zero
/// stresses), contradictory-limits (stretches), too-few-points (in the range), not-converged.
FitResult fit_material(std::span<const RubberTest> tests, const FitSettings& settings);

/// Several models, in the order given. @param tests,settings as for fit_material(); the settings'
/// model does not count. @param models names of fit_models(). @param progress called with the
/// starts that are done, with all that there are, and with the model at work; may be empty.
std::vector<FitResult> fit_materials(
    std::span<const RubberTest> tests, std::span<const std::string> models,
    const FitSettings& settings,
    const std::function<void(int done, int all, const std::string& model)>& progress = {});

/// The Bayesian information criterion of each fit (Schwarz, Ann. Statist. 6, 1978), whose least is
/// that of the model which the tests support best:
///   n ln(cost) + k ln(n),   k = parameters(),   n = sum over tests of rows (1 - r)/(1 + r).
/// n counts rows by what they are worth, since neighbouring rows of a curve miss a law alike: r is
/// `correlation` of the fit with the least cost (Bayley, Hammersley, J. R. Stat. Soc. Suppl. 8,
/// 1946). Relative errors below 1e-6 count as that. @param fits of the same tests, at least one.
std::vector<double> bayes_information(std::span<const FitResult> fits);

/// The material as scenes write it: a YAML map, with a comment that says where it comes from.
/// @param fit,tests,settings as they were fitted.
std::string material_yaml(const FitResult& fit, std::span<const RubberTest> tests,
                          const FitSettings& settings);

}  // namespace sinew::identify
