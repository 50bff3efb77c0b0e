#include "sinew/estimate/estimators.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/axis_names.hpp"
#include "sinew/core/error.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/run.hpp"

namespace sinew::estimate {

Estimators::Estimators(const EstimatorSet& set, const run::Run& run) : run_(run) {
  for (const EstimatorModel& one : set.estimators) {
    all_.emplace_back(one, *run.model, run.pool.size());
  }
}

void Estimators::begin() {
  for (Estimator& one : all_) one.begin(run_);
}

void Estimators::advance() {
  for (Estimator& one : all_) one.advance(run_);
}

void Estimators::settle(run::Rest rest) {
  if (rest == run::Rest::on_path) return;
  for (Estimator& one : all_) one.settle(run_);
}

void Estimators::save(std::vector<double>& memory) const {
  for (const Estimator& one : all_) one.save(memory);
}

void Estimators::load(std::span<const double> memory) {
  bool good = true;
  for (Estimator& one : all_) good = good && one.load(memory);
  if (good && memory.empty()) return;
  throw Error(ErrorKind::wrong_length, {.item = "estimators of the state"},
              "their memory is damaged", "take the state from a simulation of the same model");
}

std::vector<run::Reading> Estimators::readings() const {
  std::vector<run::Reading> all;
  for (const Estimator& estimator : all_) {
    const EstimatorModel& model = estimator.model();
    std::vector<run::Observable> parts;
    const auto add = [&](const Unknown& unknown, const char* of_it) {
      const bool vector = unknown.size() == 3;
      parts.push_back(observable_of(
          run::ObservableKind::estimator, model.name, unknown.name + of_it, unknown.unit,
          vector ? std::vector<std::size_t>{3} : std::vector<std::size_t>{}));
      if (!vector) return;
      for (const char* axis : kAxisNames) {
        parts.back().components.push_back(fmt::format("{}.{}", parts.back().name, axis));
      }
    };
    for (const Unknown& unknown : model.unknowns) add(unknown, "");
    for (const Unknown& unknown : model.unknowns) add(unknown, ".std");
    parts.push_back(observable_of(run::ObservableKind::estimator, model.name, "status", ""));
    for (int code = 0; code < kEstimatorStatuses; ++code) {
      parts.back().words.push_back(
          {code, estimator_status_name(static_cast<EstimatorStatus>(code))});
    }
    all.push_back({std::move(parts), [&estimator](std::span<double> numbers) {
                     run::Numbers to(numbers);
                     VectorX mean = estimator.mean(), deviation = estimator.deviation();
                     estimator.model().take_exponentials(mean, deviation);
                     for (const double component : mean) to.put(component);
                     for (const double own : deviation) to.put(own);
                     to.put(static_cast<double>(estimator.status()));
                   }});
  }
  return all;
}

}  // namespace sinew::estimate
