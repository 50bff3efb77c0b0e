/// @file
/// What a law misses tests by. Internal to this folder.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sinew/identify/fitted_law.hpp"

namespace sinew::identify {

/// A test, and which of its rows count.
struct CountedTest {
  const RubberTest* test = nullptr;
  std::vector<char> counts;  ///< of each row
  std::size_t rows = 0;      ///< that count
  double largest = 0.0;      ///< Pa, of their stresses
  double farthest = 0.0;     ///< of their |ln stretch|
};

/// Throws Error: empty-list (no tests), too-few-points (fewer than three rows count), out-of-range
/// (all stresses are zero), contradictory-limits (the range of stretches is empty).
std::vector<CountedTest> count_rows(std::span<const RubberTest> tests, const FitSettings& settings);

/// Nominal stress along a test, with softening where `mullins` is not null; zero in rows that do
/// not count, unless softening needs them.
std::vector<double> predict(const material::Hyperelastic& law, const MullinsEffect* mullins,
                            const CountedTest& test);

/// The softening of parameters. @param softening 1/r, m by the scale, beta. @param scale Pa.
MullinsEffect softening_of(const FitParameters& softening, double scale);

/// Residuals of all rows that count, each test's divided by its largest stress and the square root
/// of its rows, over the parameters. For numeric derivatives.
struct Residuals {
  const FittedLaw* law;
  const std::vector<CountedTest>* tests;
  double scale;     ///< Pa
  std::size_t own;  ///< parameters of the law; three of the softening follow where asked
  bool mullins;

  /// False where a residual is not finite.
  bool operator()(const double* parameters, double* residuals) const;
};

/// The same of Ogden's law without softening, a sum over its terms, with exact derivatives.
struct OgdenResiduals {
  const std::vector<CountedTest>* tests;
  double scale;       ///< Pa
  std::size_t terms;  ///< of two parameters each

  /// False where a residual is not finite. @param parameters (2 terms,) see FittedLaw.
  /// @param residuals (rows,), of the rows that count.
  /// @param derivatives (rows, parameters), row-major; null: not wanted.
  bool operator()(const double* parameters, double* residuals, double* derivatives) const;
};

}  // namespace sinew::identify
