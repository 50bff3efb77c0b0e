/// @file
/// Search for the parameters of hyperelastic laws. Internal to this folder.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sinew/identify/fitted_law.hpp"
#include "sinew/identify/material_residuals.hpp"

namespace sinew::identify {

/// Result of a search.
struct Attempt {
  FitParameters law, softening;                           ///< the second is empty without softening
  double cost = std::numeric_limits<double>::infinity();  ///< sum over tests, see fit_material()
  bool converged = false;
};

/// Finds the best parameters of several models and stores them. A law that contains another one
/// starts from random starts and from the solution of that one, so that it never fits worse.
class MaterialSearch {
 public:
  /// Called after every start. @param model the model that is being fitted.
  using Progress = std::function<void(const std::string& model)>;

  /// @param tests must outlive this object. @param settings whose model is ignored.
  /// @param progress may be empty.
  MaterialSearch(const std::vector<CountedTest>& tests, FitSettings settings, Progress progress);

  /// The best parameters of a model; for Ogden's law, without terms that coincide or carry no
  /// stress. Throws Error: not-converged.
  const Attempt& best(const std::string& model);
  double scale() const { return scale_; }  ///< Pa, typical modulus
  /// Number of calls of `progress` for these models.
  static int starts(std::span<const std::string> models, const FitSettings& settings);

 private:
  Attempt search(const FittedLaw& law);
  std::vector<Attempt> first_guesses(const FittedLaw& law);
  std::vector<Attempt> with_new_term(const Attempt& simpler);
  Attempt solve(const FittedLaw& law, const Attempt& start);
  Attempt without_idle_terms(const Attempt& attempt);
  bool residuals(const FittedLaw& law, const Attempt& at, std::vector<double>& result) const;
  void scale_moduli(const FittedLaw& law, Attempt& start) const;

  const std::vector<CountedTest>& tests_;
  FitSettings settings_;
  Progress progress_;
  double scale_ = 0.0;
  std::size_t rows_ = 0;
  std::map<std::string, Attempt> solved_;
};

}  // namespace sinew::identify
