/// @file
/// The estimators of one simulation.
#pragma once

#include <span>
#include <vector>

#include "sinew/sim/estimator.hpp"

namespace sinew::sim {

/// Steps estimators as a run goes on. They only look: a run takes the same bits with and without
/// them.
class Estimators {
 public:
  /// @param model outlives them. @param threads inside a step of theirs.
  Estimators(const Model& model, int threads);

  const Estimator& at(int index) const { return all_[static_cast<std::size_t>(index)]; }

  /// See Estimator.
  void begin(const Run& run);
  void advance(const Run& run);
  void settle(const Run& run);

  /// All that changes, finite numbers; nothing without estimators.
  void save(std::vector<double>& memory) const;
  /// Takes it up again. @return whether it is of the same estimators; else they have to begin().
  /// Throws Error(wrong-length) where it is theirs and incomplete.
  bool load(std::span<const double> memory);

 private:
  double signature_;  // tells sets of estimators apart in states
  std::vector<Estimator> all_;
};

}  // namespace sinew::sim
