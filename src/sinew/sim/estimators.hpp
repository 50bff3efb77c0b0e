/// @file
/// The estimators of one simulation.
#pragma once

#include <span>
#include <vector>

#include "sinew/sim/estimator.hpp"

namespace sinew::sim {

/// Updates the estimators during a run. Estimators only observe: the run is the same, bit for bit,
/// with and without them.
class Estimators {
 public:
  /// @param model must outlive them. @param threads of each estimator's robot.
  Estimators(const Model& model, int threads);

  const Estimator& at(int index) const { return all_[static_cast<std::size_t>(index)]; }

  /// See Estimator.
  void begin(const Run& run);
  void advance(const Run& run);
  void settle(const Run& run);

  /// Writes the state of all estimators as finite numbers; nothing without estimators.
  void save(std::vector<double>& memory) const;
  /// Restores the state. @return whether it belongs to the same estimators; if not, call begin().
  /// Throws Error(wrong-length) if it belongs to them but is incomplete.
  bool load(std::span<const double> memory);

 private:
  double signature_;  // tells sets of estimators apart in states
  std::vector<Estimator> all_;
};

}  // namespace sinew::sim
