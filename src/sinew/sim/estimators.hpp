/// @file
/// The estimators of one simulation.
#pragma once

#include <span>
#include <vector>

#include "sinew/sim/estimator.hpp"
#include "sinew/sim/instruments.hpp"

namespace sinew::sim {

class EstimatorSet;
struct Run;

/// Updates the estimators during a run, from its sensors.
class Estimators : public Instrument {
 public:
  /// @param set must outlive them. @param run that they observe.
  Estimators(const EstimatorSet& set, const Run& run);

  /// @param index in estimators_of().
  const Estimator& at(int index) const { return all_[static_cast<std::size_t>(index)]; }

  void begin() override;
  void advance() override;
  /// On a path, nothing is estimated: an estimator does not know that loads act partially.
  void settle(Rest rest) override;
  void save(std::vector<double>& memory) const override;
  void load(std::span<const double> memory) override;
  std::vector<Reading> readings() const override;

 private:
  const Run& run_;
  std::vector<Estimator> all_;
};

/// An estimator of a simulation. Throws Error(unknown-name) if it has none.
/// @param simulation with estimators. @param index in estimators_of().
template <class Simulation>
const Estimator& estimator_of(const Simulation& simulation, int index) {
  return simulation.instruments().template get<Estimators>().at(index);
}

}  // namespace sinew::sim
