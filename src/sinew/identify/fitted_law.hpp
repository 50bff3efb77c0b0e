/// @file
/// Hyperelastic laws as functions of their fitted parameters. Internal to this folder.
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

/// A fitted parameter.
struct FitParameter {
  double value = 1.0;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool modulus = false;  ///< relative to a scale, Pa; the stress is proportional to all moduli
};
using FitParameters = std::vector<FitParameter>;

/// A law as a function of its parameters. Those of Ogden's law are pairs: each term's share mu
/// alpha/2 of the initial shear modulus, and alpha, whose sign does not change in a search.
struct FittedLaw {
  std::string model;
  bool linear = false;  ///< in its parameters: one start suffices
  bool ogden = false;
  /// Draws a random initial guess.
  std::function<FitParameters(std::mt19937_64&)> draw;
  /// Builds the law. @param parameters of draw(), possibly followed by others. @param scale Pa.
  std::function<material::Hyperelastic(const double* parameters, double scale)> build;
  std::function<std::vector<Coefficient>(const double* parameters, double scale)> tell;
};

/// The law of a name of fit_models(). Throws Error: unknown-choice.
FittedLaw fitted_law(const std::string& model);

/// Ogden's law with any number of terms.
FittedLaw ogden_law(std::size_t terms);

/// The two parameters of a term of Ogden's law. @param share of the initial shear modulus, relative
/// to the scale. @param alpha not 0.
FitParameters ogden_term(double share, double alpha);

/// Nominal stress of a term of Ogden's law with the share 1 of a shear modulus of 1 Pa, and its
/// derivative with respect to the exponent, for an incompressible material with a stress-free face:
///   P = 2/alpha (l_1^alpha - l_3^alpha)/l_1.
struct TermStress {
  double value = 0.0, by_alpha = 0.0;
};
/// Computes the stress of a term. @param mode,stretch of the test. @param alpha not 0.
TermStress term_stress(material::DeformationMode mode, double stretch, double alpha);

/// The model that is contained in `model` and fitted before it; empty if there is none.
std::string contained_model(const std::string& model);

/// Parameters of `model` that give the same law as those of contained_model(): the parameters of
/// the simpler law, with zero moduli for the new terms. For Ogden's law, the same terms and no new
/// one.
FitParameters embedded(const std::string& model, const FitParameters& contained);

}  // namespace sinew::identify
