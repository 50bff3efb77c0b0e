#include "sinew/sim/estimators.hpp"

#include "sinew/core/error.hpp"
#include "sinew/core/named_hash.hpp"
#include "sinew/sim/estimator_model.hpp"
#include "sinew/sim/model.hpp"

namespace sinew::sim {

namespace {

// Hash of the robots, sensors and unknowns of a saved state, as an integer that a double represents
// exactly.
double signature_of(const std::vector<EstimatorModel>& estimators) {
  ValueHash hash;
  for (const EstimatorModel& one : estimators) {
    hash.add(one.lags, one.robot->fingerprint(), one.unknowns.size());
    for (const EstimatorSensor& sensor : one.sensors) hash.add(sensor.index, sensor.size);
    for (const Unknown& unknown : one.unknowns) {
      hash.add(unknown.first_actuator, unknown.size(), unknown.command_known);
      if (unknown.kind == Unknown::Kind::stiffness) hash.add(unknown.body);
    }
  }
  return static_cast<double>(hash.value() >> 12);
}

}  // namespace

Estimators::Estimators(const Model& model, int threads)
    : signature_(signature_of(model.estimators())) {
  for (const EstimatorModel& one : model.estimators()) all_.emplace_back(one, model, threads);
}

void Estimators::begin(const Run& run) {
  for (Estimator& one : all_) one.begin(run);
}

void Estimators::advance(const Run& run) {
  for (Estimator& one : all_) one.advance(run);
}

void Estimators::settle(const Run& run) {
  for (Estimator& one : all_) one.settle(run);
}

void Estimators::save(std::vector<double>& memory) const {
  memory.clear();
  if (all_.empty()) return;
  memory.push_back(signature_);
  for (const Estimator& one : all_) one.save(memory);
}

bool Estimators::load(std::span<const double> memory) {
  if (all_.empty()) return true;
  if (memory.empty() || memory.front() != signature_) return false;
  memory = memory.subspan(1);
  bool good = true;
  for (Estimator& one : all_) good = good && one.load(memory);
  if (good && memory.empty()) return true;
  throw Error(ErrorKind::wrong_length, {.item = "estimators of the state"},
              "their memory is damaged", "take the state from a simulation of the same model");
}

}  // namespace sinew::sim
