/// @file
/// Hyperelastic laws as functions of the numbers that a fit looks for. Internal to this folder.
#pragma once

#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "sinew/identify/material_fit.hpp"
#include "sinew/material/hyperelastic.hpp"

namespace sinew::identify {

inline constexpr double kLargestExponent = 30.0, kSmallestExponent = 0.1;

/// One number that is fitted.
struct FitParameter {
  double value = 1.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool modulus = false;  ///< in units of a scale, Pa; the stress is proportional to all of them
};
using FitParameters = std::vector<FitParameter>;

/// A law by its parameters. Ogden's are pairs: each term's share mu alpha/2 of the initial shear
/// modulus, and alpha, whose sign a search does not change.
struct FittedLaw {
  std::string model;
  bool linear = false;  ///< in its parameters: one start will do
  bool ogden = false;
  /// Where a search may start, at random.
  std::function<FitParameters(std::mt19937_64&)> draw;
  /// @param parameters of draw(), perhaps with more behind. @param scale Pa.
  std::function<material::Hyperelastic(const double* parameters, double scale)> build;
  std::function<std::vector<Coefficient>(const double* parameters, double scale)> tell;
};

/// A name of fit_models(). Throws Error(unknown-choice).
FittedLaw fitted_law(const std::string& model);

/// Ogden's law of any number of terms.
FittedLaw ogden_law(std::size_t terms);

/// A term of Ogden's law as its two parameters. @param share of the initial shear modulus, by the
/// scale. @param alpha not 0.
FitParameters ogden_term(double share, double alpha);

/// Nominal stress of a term of Ogden's law with the share 1 of a shear modulus of 1 Pa, and its
/// derivative by the exponent, of an incompressible material whose free face bears nothing:
///   P = 2/alpha (l_1^alpha - l_3^alpha)/l_1.
struct TermStress {
  double value = 0.0, by_alpha = 0.0;
};
/// @param mode,stretch of the test. @param alpha not 0.
TermStress term_stress(material::DeformationMode mode, double stretch, double alpha);

/// The model that `model` contains and that is fitted before it; empty for none.
std::string contained_model(const std::string& model);

/// Parameters of `model` that give the same law as those of contained_model(): the simpler one's
/// with zero moduli for what is new. Of Ogden's law the same terms, none new.
FitParameters embedded(const std::string& model, const FitParameters& contained);

}  // namespace sinew::identify
