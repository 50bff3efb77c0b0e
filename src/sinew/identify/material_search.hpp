/// @file
/// The search for the parameters of hyperelastic laws. Internal to this folder.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sinew/identify/fitted_law.hpp"
#include "sinew/identify/material_residuals.hpp"

namespace sinew::identify {

/// Parameters that a search ended with.
struct Attempt {
  FitParameters law, softening;                           ///< the second empty without
  double cost = std::numeric_limits<double>::infinity();  ///< sum over tests, see fit_material()
  bool converged = false;
};

/// Finds the best parameters of one model after the other and remembers them: a law that contains
/// another one starts, beside random starts, from that one's solution, so that it never fits worse.
class MaterialSearch {
 public:
  /// Called after every start. @param model that is being fitted.
  using Progress = std::function<void(const std::string& model)>;

  /// @param tests kept by reference. @param settings whose model is not used.
  /// @param progress may be empty.
  MaterialSearch(const std::vector<CountedTest>& tests, FitSettings settings, Progress progress);

  /// Of Ogden's law without terms that coincide or carry nothing. Throws Error(not-converged).
  const Attempt& best(const std::string& model);
  double scale() const { return scale_; }  ///< Pa, the size of a modulus
  /// How often `progress` will be called for these models.
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
