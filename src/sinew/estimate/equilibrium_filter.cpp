#include "sinew/estimate/equilibrium_filter.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/estimate/step_response.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::estimate {

EquilibriumFilter::EquilibriumFilter(const EstimatorModel& model, int threads)
    : EstimatorFilter(model, threads),
      filter_(model.of_components(&Unknown::prior), model.of_components(&Unknown::walk),
              model.lags),
      settled_from_(filter_),
      predicted_(filter_) {
  const std::vector<int> actuators = model.actuators();
  for (std::size_t k = 0; k < actuators.size(); ++k) {
    if (actuators[k] < 0) continue;
    controlled_.push_back(actuators[k]);
    with_.push_back(static_cast<Eigen::Index>(k));
  }
  EquilibriumFilter::forget();
}

bool EquilibriumFilter::iterates() const { return model().has_stiffness(); }

void EquilibriumFilter::forget() {
  filter_.restart();
  const Eigen::Index count = model().readings(), size = filter_.size();
  instants_.assign(static_cast<std::size_t>(filter_.lags()) + 1,
                   {false, VectorX::Zero(size), VectorX::Zero(count), MatrixX::Zero(count, size)});
}

void EquilibriumFilter::begin_settling() {
  for (Instant& instant : instants_) instant.known = false;  // late samples are discarded
  settled_from_ = filter_;
}

void EquilibriumFilter::predict(const run::Run& run, double time_step) {
  filter_.predict(time_step);
  std::rotate(instants_.begin(), instants_.end() - 1, instants_.end());  // as a range: no clang 14
  if (iterates()) {
    predicted_ = filter_;
    start_ = own_robot().state();
  }
  take_up(run, filter_.mean(), false);
}

// If the robot fails, the results of the previous round are kept.
bool EquilibriumFilter::predict_again(const run::Run& run) {
  const Instant before = instants_.front();
  const run::State after = own_robot().state();
  const estimate::RandomWalkFilter corrected = std::exchange(filter_, predicted_);
  own_robot().restore(start_);
  take_up(run, corrected.mean(), false);
  if (instants_.front().known) return true;
  instants_.front() = before;
  filter_ = corrected;
  own_robot().restore(after);
  return false;
}

// If the robot fails, the results of the previous round, if any, are kept.
bool EquilibriumFilter::predict_rest(const run::Run& run) {
  const Instant before = instants_.front();
  const run::State from = own_robot().state();
  take_up(run, filter_.mean(), true);
  if (instants_.front().known) {
    filter_ = settled_from_;
    return true;
  }
  if (before.known) {
    instants_.front() = before;
    own_robot().restore(from);
  }
  return false;
}

void EquilibriumFilter::take_up(const run::Run& run, const VectorX& unknowns, bool settles) {
  Instant& now = instants_.front();
  now.known = move(run, unknowns, settles);
  now.unknowns = acted();
  if (!now.known) return;
  now.readings = readings();
  now.sensitivity = sensitivity();
  if (model().has_stiffness()) now.known = add_stiffness(run, settles);
}

// Steps start where the robot started, equilibria from the one that was found.
bool EquilibriumFilter::add_stiffness(const run::Run& run, bool settles) {
  constexpr double kDifference = 0.01;
  Instant& now = instants_.front();
  const run::State after = own_robot().state();
  const std::vector<int> actuators = model().actuators();
  bool good = true;
  for (Eigen::Index k = 0; k < filter_.size() && good; ++k) {
    if (actuators[static_cast<std::size_t>(k)] >= 0) continue;
    own_robot().restore(settles ? after : start_);
    good = move(run, now.unknowns + kDifference * VectorX::Unit(filter_.size(), k), settles);
    if (!good) break;
    now.sensitivity.col(k) = reading_difference(readings(), now.readings) / kDifference;
  }
  own_robot().restore(after);
  return good;
}

MatrixX EquilibriumFilter::sensitivity() {
  MatrixX all = MatrixX::Zero(model().readings(), filter_.size());
  if (controlled_.empty()) return all;
  const StepResponse response(own_robot(), controlled_);
  const model::Model& robot = *model().robot;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model().sensors.size(); ++k) {
    const EstimatorSensor& sensor = model().sensors[k];
    const sense::SensorSource* source = sense::sensors_of(robot)[k].source.get();
    const auto row_of = [&](int actuator) {
      return robot.actuators()[static_cast<std::size_t>(actuator)].row;
    };
    const auto rows = static_cast<Eigen::Index>(sensor.size);
    auto own = all(Eigen::seqN(first, rows), with_);
    if (sensor.effector >= 0) {
      own = response.motions(robot.effector(sensor.effector).first_row(), 3);
    } else if (const auto* motion = dynamic_cast<const sense::MotionSource*>(source)) {
      own = response.motions(row_of(motion->actuator()), 1);
    } else {
      const auto& effort = dynamic_cast<const sense::EffortSource&>(*source);
      own = effort.factor() * response.effort(row_of(effort.actuator()));
    }
    first += rows;
  }
  return all;
}

VectorX EquilibriumFilter::beyond_path(int lag) const {
  const Instant& then = at(lag);
  return then.sensitivity * (filter_.mean(lag) - then.unknowns);
}

void EquilibriumFilter::correct(int lag, Eigen::Index first, const VectorX& innovation,
                                const VectorX& variance) {
  filter_.correct(lag, at(lag).sensitivity.middleRows(first, innovation.size()), innovation,
                  variance);
}

estimate::Observability EquilibriumFilter::observability(const VectorX& variance) const {
  const Instant& now = instants_.front();
  MatrixX sensitivity = now.sensitivity;
  if (!now.known) sensitivity.setZero();
  return estimate::observability(sensitivity, variance, filter_.prior());
}

// Visitor(number) of a double or a bool.
template <class Self, class Visitor>
void EquilibriumFilter::visit_memory(Self& self, Visitor&& visitor) {
  const auto each = [&](auto& matrix) {
    for (auto& number : matrix.reshaped()) visitor(number);
  };
  for (auto& instant : self.instants_) {
    visitor(instant.known);
    each(instant.unknowns);
    each(instant.readings);
    each(instant.sensitivity);
  }
}

void EquilibriumFilter::save_own(std::vector<double>& memory) const {
  visit_memory(*this, [&](auto number) { memory.push_back(static_cast<double>(number)); });
  filter_.save(memory);
}

bool EquilibriumFilter::load_own(std::span<const double>& memory) {
  bool good = true;
  visit_memory(*this, [&](auto& number) {
    good = good && !memory.empty();
    if (!good) return;
    using Number = std::remove_reference_t<decltype(number)>;
    if constexpr (std::integral<Number>) {
      number = whole<Number>(memory.front());
    } else {
      number = static_cast<Number>(memory.front());
    }
    memory = memory.subspan(1);
  });
  return good && filter_.load(memory);
}

}  // namespace sinew::estimate
