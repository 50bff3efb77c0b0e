/// @file
/// Residuals of a law on tests. Internal to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/identify/fitted_law.hpp"

namespace sinew::identify {

/// A test, and which of its rows are fitted.
struct CountedTest {
  const RubberTest* test = nullptr;
  std::vector<char> counts;  ///< (rows of the test,) 1: fitted
  std::size_t rows = 0;      ///< number of fitted rows
  double largest = 0.0;      ///< Pa, largest |stress| of these
  double farthest = 0.0;     ///< largest |ln stretch| of these
};

/// Selects the rows to be fitted. Throws Error: empty-list (no tests), too-few-points (fewer than
/// three rows), out-of-range (all stresses are zero), contradictory-limits (an empty range of
/// stretches).
std::vector<CountedTest> count_rows(std::span<const RubberTest> tests, const FitSettings& settings);

/// Nominal stress along a test, with softening unless `mullins` is null; zero in rows that are not
/// fitted, unless softening needs them.
std::vector<double> predict(const material::Hyperelastic& law, const MullinsEffect* mullins,
                            const CountedTest& test);

/// The softening for given parameters. @param softening 1/r, m over the scale, beta. @param scale
/// Pa.
MullinsEffect softening_of(const FitParameters& softening, double scale);

/// Residuals of all fitted rows as functions of the parameters, divided by the largest stress of
/// their test and the square root of its number of rows. For numerical derivatives.
struct Residuals {
  const FittedLaw* law;
  const std::vector<CountedTest>* tests;
  double scale;     ///< Pa
  std::size_t own;  ///< number of parameters of the law; with `mullins`, three of softening follow
  bool mullins;

  /// Returns false if a residual is not finite.
  bool operator()(const double* parameters, double* residuals) const;
};

/// The same for Ogden's law without softening, a sum over its terms, with exact derivatives.
struct OgdenResiduals {
  const std::vector<CountedTest>* tests;
  double scale;       ///< Pa
  std::size_t terms;  ///< of two parameters each

  /// Returns false if a residual is not finite. @param parameters (2 terms,) see FittedLaw.
  /// @param residuals (rows,), of the fitted rows.
  /// @param derivatives (rows, parameters), row-major; null: not requested.
  bool operator()(const double* parameters, double* residuals, double* derivatives) const;
};

}  // namespace sinew::identify
