/// @file
/// Coefficients of hyperelastic laws from tests, by bounded least squares.
#pragma once

#include <cstdint>
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
  int starts = 20;  ///< random ones, for laws that are not linear in their coefficients
  std::uint64_t seed = 1;
  bool mullins = false;
  double poisson_ratio = 0.49;  ///< of the material that is written; tests are taken incompressible
};

/// One coefficient by the name that scenes use.
struct Coefficient {
  std::string name;
  double value = 0.0;
  const char* unit = "";
};

/// How well a law meets one test.
struct TestFit {
  double rms = 0.0;            ///< Pa
  double relative = 0.0;       ///< over the test's largest stress
  std::vector<double> stress;  ///< nominal, Pa, at the test's stretches
};

struct FitResult {
  std::string model;
  std::vector<Coefficient> coefficients;
  material::Hyperelastic energy;  ///< with the bulk modulus of the settings' Poisson's ratio
  std::optional<MullinsEffect> mullins;
  std::vector<TestFit> tests;  ///< as given
  double cost = 0.0;           ///< mean over tests of their relative RMS squared
  int best_start = 0;
  /// Stretches between which the law is stable after Drucker, in tension and pressure, equibiaxial
  /// and planar; within 0.1 to 10.
  std::pair<double, double> uniaxial_range, equibiaxial_range, planar_range;
  bool converged = false;
};

/// Names of all models.
std::vector<std::string> fit_models();

/// Minimises sum over tests of mean((P - P_measured)^2)/max(P_measured)^2, so that every test
/// counts the same. Ogden's terms keep mu alpha >= 0, which makes each of them stable; exponents
/// stay within 30. Trust region with bounds (Ceres), from random starts that a seed determines.
/// Throws Error: empty-list (no tests), unknown-choice (model), out-of-range (starts, ratio).
FitResult fit_material(std::span<const RubberTest> tests, const FitSettings& settings);

/// The material as scenes write it: a YAML map, with a comment that says where it comes from.
std::string material_yaml(const FitResult& fit, std::span<const RubberTest> tests,
                          double poisson_ratio);

}  // namespace sinew::identify
