/// @file
/// Fits the coefficients of hyperelastic laws to tests, by bounded least squares.
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

/// Model and options of a fit.
struct FitSettings {
  /// "neo-hookean", "mooney-rivlin", "yeoh1" to "yeoh3", "ogden1" to "ogden6", "arruda-boyce".
  std::string model = "ogden3";
  int starts = 5;  ///< number of random starts, for laws that are nonlinear in their coefficients
  std::uint64_t seed = 1;
  bool mullins = false;
  double poisson_ratio = 0.49;  ///< of the written material; tests are assumed incompressible
  /// Range of stretches; rows outside are not fitted, but count for the history of softening.
  double min_stretch = 0.0, max_stretch = std::numeric_limits<double>::infinity();
};

/// A coefficient, with its name in scene files.
struct Coefficient {
  std::string name;
  double value = 0.0;
  const char* unit = "";
};

/// How well a law fits one test.
struct TestFit {
  std::size_t rows = 0;        ///< number of fitted rows, to which the next three refer
  double rms = 0.0;            ///< Pa
  double relative = 0.0;       ///< relative to the test's largest stress
  double correlation = 0.0;    ///< of the residuals of neighbouring rows, -1 to 1
  std::vector<double> stress;  ///< nominal, Pa, at all stretches of the test
};

/// A fitted law.
struct FitResult {
  std::string model;
  /// For Ogden's law, those of distinct terms that carry stress; possibly fewer than requested.
  std::vector<Coefficient> coefficients;
  material::Hyperelastic energy;  ///< with the bulk modulus of the settings' Poisson's ratio
  std::optional<MullinsEffect> mullins;
  std::vector<TestFit> tests;  ///< as given
  double cost = 0.0;           ///< mean over tests of the squared relative RMS
  /// Ranges of stretch in which the law is stable by Drucker's criterion: uniaxial (tension and
  /// compression), equibiaxial and planar; within 0.1 to 10.
  std::pair<double, double> uniaxial_range, equibiaxial_range, planar_range;
  bool converged = false;

  /// Number of fitted parameters, including those of softening.
  int parameters() const { return static_cast<int>(coefficients.size()) + (mullins ? 3 : 0); }
};

/// Names of all models.
std::vector<std::string> fit_models();

/// Fits a law. It minimises the sum over tests of mean((P - P_measured)^2)/max(P_measured)^2, so
/// that every test has the same weight. The terms of Ogden's law keep mu alpha >= 0, which makes
/// each of them stable; exponents stay within 30. Uses a trust region with bounds (Ceres), from
/// random starts that a seed determines, and from the solution of the contained model (for Ogden's
/// law, that with one term less, to which the term that reduces the cost most is added). A richer
/// model of a family therefore never fits worse.
/// Throws Error: empty-list (no tests), unknown-choice (model), out-of-range (starts, ratio, zero
/// stresses), contradictory-limits (stretches), too-few-points (in the range), not-converged.
FitResult fit_material(std::span<const RubberTest> tests, const FitSettings& settings);

/// Fits several models, in the order given. @param tests,settings as for fit_material(); the model
/// of the settings is ignored. @param models names of fit_models().
/// @param progress called with the number of starts done, that of all starts, and the present
///   model; may be empty.
std::vector<FitResult> fit_materials(
    std::span<const RubberTest> tests, std::span<const std::string> models,
    const FitSettings& settings,
    const std::function<void(int done, int all, const std::string& model)>& progress = {});

/// The Bayesian information criterion of each fit (Schwarz, Ann. Statist. 6, 1978). It is least for
/// the model that the tests support best:
///   n ln(cost) + k ln(n),   k = parameters(),   n = sum over tests of rows (1 - r)/(1 + r).
/// n is an effective number of rows, since neighbouring rows of a curve have similar residuals: r
/// is `correlation` of the fit with the least cost (Bayley, Hammersley, J. R. Stat. Soc. Suppl. 8,
/// 1946). Relative errors below 1e-6 count as 1e-6. @param fits of the same tests, at least one.
std::vector<double> bayes_information(std::span<const FitResult> fits);

/// The material as a YAML map for scene files, with a comment on its origin.
/// @param fit,tests,settings of the fit.
std::string material_yaml(const FitResult& fit, std::span<const RubberTest> tests,
                          const FitSettings& settings);

}  // namespace sinew::identify
