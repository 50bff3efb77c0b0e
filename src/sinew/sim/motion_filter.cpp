#include "sinew/sim/motion_filter.hpp"

#include <algorithm>

#include "sinew/sim/estimator_model.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::sim {

namespace {

// e: large compared with the tolerance of a step, small enough for its second derivative.
constexpr double kDifference = 0.1;

VectorX body_numbers(const State& state) {
  Eigen::Index count = 0;
  for (const auto& body : state.bodies) count += std::ssize(body);
  VectorX all(count);
  double* next = all.data();
  for (const auto& body : state.bodies) next = std::ranges::copy(body, next).out;
  return all;
}

// Sensors restart there: those of rates would otherwise refer to the state before the displacement.
State moved(const State& from, const VectorX& way) {
  State state = from;
  Eigen::Index next = 0;
  for (auto& body : state.bodies) {
    for (double& number : body) number += way[next++];
  }
  state.sensors.clear();
  return state;
}

}  // namespace

MotionFilter::MotionFilter(const EstimatorModel& model, int threads)
    : EstimatorFilter(model, threads),
      filter_(model.of_components(&Unknown::prior), model.of_components(&Unknown::walk),
              model.readings(), body_numbers(own_robot().state()).size(), model.lags, model.rank),
      settled_from_(filter_) {
  MotionFilter::forget();
}

void MotionFilter::forget() {
  filter_.restart();
  path_.assign(static_cast<std::size_t>(filter_.lags()) + 1, VectorX::Zero(model().readings()));
  known_.assign(path_.size(), 0.0);
}

void MotionFilter::begin_settling() {
  std::ranges::fill(known_, 0.0);
  settled_from_ = filter_;
}

void MotionFilter::predict(const Run& run, double time_step) {
  const State before = own_robot().state();
  const State from = moved(before, filter_.state_deviation());
  own_robot().restore(from);
  filter_.take_state();
  filter_.begin_step(time_step);
  std::rotate(path_.begin(), path_.end() - 1, path_.end());
  std::rotate(known_.begin(), known_.end() - 1, known_.end());
  known_.front() = move_columns(run, from, false) ? 1.0 : 0.0;
  // A correction that the robot cannot follow is dropped; otherwise every later step would start
  // from it.
  if (failed() && own_robot().steps() == before.steps) own_robot().restore(before);
  filter_.end_step();
}

void MotionFilter::predict_rest(const Run& run) {
  const State from = own_robot().state();
  const VectorX unknowns = filter_.mean();
  filter_ = settled_from_;
  filter_.begin_rest();
  filter_.put_mean(unknowns);
  known_.front() = move_columns(run, from, true) ? 1.0 : 0.0;
  const VectorX acted = filter_.mean();
  filter_.put_mean(settled_from_.mean());
  if (known_.front() != 0.0) filter_.end_rest(acted);
}

// Where an unknown is at its bound, columns are perturbed to the side on which it is free.
bool MotionFilter::move_columns(const Run& run, const State& from, bool settles) {
  if (!move(run, filter_.mean(), settles)) return false;
  const VectorX unknowns = acted();
  filter_.put_mean(unknowns);
  path_.front() = readings();
  const State after = own_robot().state();
  const VectorX reached = body_numbers(after);
  bool good = true;
  for (Eigen::Index k = 0; k < filter_.columns() && good; ++k) {
    const auto go = [&](double part) {
      const VectorX wanted = unknowns + part * filter_.input_column(k);
      own_robot().restore(moved(settles ? after : from, part * filter_.state_column(k)));
      good = move(run, wanted, settles);
      return good && acted() == wanted;
    };
    double part = kDifference;
    if (!go(part)) go(part = -part);
    if (!good) break;
    filter_.put_column(k, reading_difference(readings(), path_.front()) / part,
                       (body_numbers(own_robot().state()) - reached) / part);
  }
  own_robot().restore(after);
  return good;
}

VectorX MotionFilter::reading_difference(const VectorX& to, const VectorX& from) const {
  VectorX all(to.size());
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model().sensors.size(); ++k) {
    const auto size = static_cast<Eigen::Index>(model().sensors[k].size);
    all.segment(first, size) =
        model().difference(k, to.segment(first, size), from.segment(first, size));
    first += size;
  }
  return all;
}

void MotionFilter::correct(int lag, Eigen::Index first, const VectorX& innovation,
                           const VectorX& variance) {
  filter_.correct(lag, first, innovation, variance);
}

estimate::Observability MotionFilter::observability(const VectorX& /*variance*/) const {
  return estimate::observability(filter_.covariance(), filter_.prior());
}

void MotionFilter::save_own(std::vector<double>& memory) const {
  for (const VectorX& readings : path_) {
    memory.insert(memory.end(), readings.data(), readings.data() + readings.size());
  }
  memory.insert(memory.end(), known_.begin(), known_.end());
  filter_.save(memory);
}

bool MotionFilter::load_own(std::span<const double>& memory) {
  const auto take = [&](auto& numbers) {
    const auto size = static_cast<std::size_t>(numbers.size());
    if (memory.size() < size) return false;
    std::ranges::copy(memory.first(size), numbers.data());
    memory = memory.subspan(size);
    return true;
  };
  return std::ranges::all_of(path_, take) && take(known_) && filter_.load(memory);
}

}  // namespace sinew::sim
