#include "sinew/estimate/estimator_model.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/axis_names.hpp"
#include "sinew/core/named_hash.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/estimate/estimators.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/named_index.hpp"
#include "sinew/run/run.hpp"
#include "sinew/sim/state_io.hpp"

namespace sinew::estimate {

Eigen::Index EstimatorModel::size() const {
  return std::accumulate(unknowns.begin(), unknowns.end(), Eigen::Index{0},
                         [](Eigen::Index sum, const auto& one) { return sum + one.size(); });
}

Eigen::Index EstimatorModel::readings() const {
  return std::accumulate(
      sensors.begin(), sensors.end(), Eigen::Index{0},
      [](Eigen::Index sum, const auto& one) { return sum + static_cast<Eigen::Index>(one.size); });
}

std::vector<std::string> EstimatorModel::component_names() const {
  std::vector<std::string> names;
  for (const Unknown& unknown : unknowns) {
    if (unknown.kind != Unknown::Kind::force) {
      names.push_back(unknown.name);
      continue;
    }
    for (const char* axis : kAxisNames) names.push_back(unknown.name + "." + axis);
  }
  return names;
}

VectorX EstimatorModel::of_components(double Unknown::*number) const {
  VectorX all(size());
  Eigen::Index first = 0;
  for (const Unknown& unknown : unknowns) {
    all.segment(first, unknown.size()).setConstant(unknown.*number);
    first += unknown.size();
  }
  return all;
}

VectorX EstimatorModel::difference(std::size_t sensor, const VectorX& to,
                                   const VectorX& from) const {
  const int effector = sensors[sensor].effector;
  const bool turns =
      effector >= 0 && robot->effector(effector).kind() == constraint::EffectorKind::orientation;
  if (!turns) return to - from;
  return rotation_vector(rotation_matrix(Vector3(to)) * rotation_matrix(Vector3(from)).transpose());
}

std::vector<int> EstimatorModel::actuators() const {
  std::vector<int> all;
  for (const Unknown& unknown : unknowns) {
    const bool none = unknown.kind == Unknown::Kind::stiffness;
    for (int k = 0; k < unknown.size(); ++k) all.push_back(none ? -1 : unknown.first_actuator + k);
  }
  return all;
}

bool EstimatorModel::has_stiffness() const {
  return std::ranges::find(unknowns, Unknown::Kind::stiffness, &Unknown::kind) != unknowns.end();
}

void EstimatorModel::take_exponentials(VectorX& mean, VectorX& deviation) const {
  Eigen::Index k = 0;
  for (const Unknown& unknown : unknowns) {
    if (unknown.kind == Unknown::Kind::stiffness) {
      mean[k] = std::exp(mean[k]);
      deviation[k] *= mean[k];
    }
    k += unknown.size();
  }
}

// Of the robots, sensors and unknowns, and of the layout of the robots' states, which the memory
// contains: an older one is not read, and the estimators begin afresh.
std::uint64_t EstimatorSet::hash() const {
  ValueHash hash;
  hash.add(sim::kStateVersion);
  for (const EstimatorModel& one : estimators) {
    hash.add(one.lags, one.robot->fingerprint(), one.unknowns.size());
    for (const EstimatorSensor& sensor : one.sensors) hash.add(sensor.index, sensor.size);
    for (const Unknown& unknown : one.unknowns) {
      hash.add(unknown.first_actuator, unknown.size(), unknown.command_known);
      if (unknown.kind == Unknown::Kind::stiffness) hash.add(unknown.body);
    }
  }
  return hash.value();
}

std::unique_ptr<run::Instrument> EstimatorSet::start(const run::Run& run) const {
  return std::make_unique<Estimators>(*this, run);
}

const std::vector<EstimatorModel>& estimators_of(const model::Model& model) {
  static const std::vector<EstimatorModel> kNone;
  const auto* set = model.instrument<const EstimatorSet>();
  return set != nullptr ? set->estimators : kNone;
}

int estimator_index(const model::Model& model, std::string_view name) {
  return model::index_of_name(estimators_of(model), name, "estimator",
                              [](const auto& e) { return e.name; });
}

}  // namespace sinew::estimate
