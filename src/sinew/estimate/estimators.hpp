/// @file
/// The estimators of one simulation.
#pragma once

#include <span>
#include <vector>

#include "sinew/estimate/estimator.hpp"
#include "sinew/run/instruments.hpp"

namespace sinew::run {
struct Run;
}

namespace sinew::estimate {

class EstimatorSet;

/// Updates the estimators during a run, from its sensors.
class Estimators : public run::Instrument {
 public:
  /// @param set must outlive them. @param run that they observe.
  Estimators(const EstimatorSet& set, const run::Run& run);

  /// @param index in estimators_of().
  const Estimator& at(int index) const { return all_[static_cast<std::size_t>(index)]; }

  void begin() override;
  void advance() override;
  /// On a path, nothing is estimated: an estimator does not know that loads act partially.
  void settle(run::Rest rest) override;
  void save(std::vector<double>& memory) const override;
  void load(std::span<const double> memory) override;
  std::vector<run::Reading> readings() const override;

 private:
  const run::Run& run_;
  std::vector<Estimator> all_;
};

/// An estimator of a simulation. Throws Error(unknown-name) if it has none.
/// @param simulation with estimators. @param index in estimators_of().
template <class Simulation>
const Estimator& estimator_of(const Simulation& simulation, int index) {
  return simulation.instruments().template get<Estimators>().at(index);
}

}  // namespace sinew::estimate
