#include "sinew/estimate/motion_filter.hpp"

#include <algorithm>

#include "sinew/estimate/estimator_model.hpp"
#include "sinew/model/model.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::estimate {

namespace {

// e: large compared with the tolerance of a step, small enough for its second derivative.
constexpr double kDifference = 0.1;

VectorX body_numbers(const run::State& state) {
  Eigen::Index count = 0;
  for (const auto& body : state.bodies) count += std::ssize(body);
  VectorX all(count);
  double* next = all.data();
  for (const auto& body : state.bodies) next = std::ranges::copy(body, next).out;
  return all;
}

// Sensors restart there: those of rates would otherwise refer to the state before the displacement.
run::State moved(const run::State& from, const VectorX& way) {
  run::State state = from;
  Eigen::Index next = 0;
  for (auto& body : state.bodies) {
    for (double& number : body) number += way[next++];
  }
  state.instruments.clear();
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

// If the path fails from the corrected state, the correction of the state is dropped, since every
// later step would start from there. If only a column fails, the correction is kept.
void MotionFilter::predict(const run::Run& run, double time_step) {
  const run::State before = own_robot().state();
  const run::State from = moved(before, filter_.state_deviation());
  own_robot().restore(from);
  filter_.take_state();
  filter_.begin_step(time_step);
  std::rotate(path_.begin(), path_.end() - 1, path_.end());
  std::rotate(known_.begin(), known_.end() - 1, known_.end());
  const Outcome outcome = move_all(run, from, false);
  known_.front() = outcome == Outcome::moved ? 1.0 : 0.0;
  if (outcome == Outcome::column_failed) own_robot().restore(from);
  if (outcome == Outcome::path_failed) own_robot().restore(before);
  filter_.end_step();
}

// If the robot fails, the results of the previous round, if any, are kept.
bool MotionFilter::predict_rest(const run::Run& run) {
  const run::State from = own_robot().state();
  const VectorX path = path_.front();
  const estimate::ReducedRankFilter before = filter_;
  filter_ = settled_from_;
  filter_.begin_rest();
  filter_.put_mean(before.mean());
  if (move_all(run, from, true) != Outcome::moved) {
    filter_ = before;
    path_.front() = path;
    own_robot().restore(from);
    return false;
  }
  known_.front() = 1.0;
  const VectorX acted = filter_.mean();
  filter_.put_mean(settled_from_.mean());
  filter_.end_rest(acted);
  return true;
}

MotionFilter::Outcome MotionFilter::move_all(const run::Run& run, const run::State& from,
                                             bool settles) {
  if (!move(run, filter_.mean(), settles)) return Outcome::path_failed;
  const VectorX wanted = filter_.mean();
  filter_.put_mean(acted());
  path_.front() = readings();
  const run::State after = own_robot().state();
  const Reached reached{settles ? after : from, body_numbers(after), settles};
  const Eigen::Index m = path_.front().size(), states = reached.numbers.size();
  MatrixX columns = MatrixX::Zero(m + states, filter_.columns());
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    if (move_column(run, reached, k, columns.col(k))) continue;
    filter_.put_mean(wanted);
    return Outcome::column_failed;
  }
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    filter_.put_column(k, columns.col(k).head(m), columns.col(k).tail(states));
  }
  own_robot().restore(after);
  return Outcome::moved;
}

// At a bound of an unknown, F has only a one-sided derivative, so the difference is taken on the
// side within the bound. If du moves some unknowns out of their bounds and -du others, it is split
// into du = du_1 + du_2, where u + e du_1 and u - e du_2 are within the bounds. With the one-sided
// derivatives and to first order in e,
//   F(s + e ds, u + e du_1) - F(s, u - e du_2) = e F_s ds + e F_u du.
bool MotionFilter::move_column(const run::Run& run, const Reached& reached, Eigen::Index k,
                               Eigen::Ref<VectorX> column) {
  const VectorX unknowns = filter_.mean(), all = filter_.input_column(k);
  const VectorX state = filter_.state_column(k);
  if (all.isZero(0.0) && state.isZero(0.0)) return true;  // a constant unknown adds such a column
  const auto free_part = [&](double part) -> VectorX {
    const VectorX wanted = unknowns + part * all;
    return (bounded(run, wanted).array() == wanted.array()).select(all, 0.0);
  };
  const auto add = [&](double part, const VectorX& way, const VectorX& inputs) {
    own_robot().restore(moved(reached.start, part * way));
    if (!move(run, unknowns + part * inputs, reached.settles)) return false;
    column.head(path_.front().size()) += reading_difference(readings(), path_.front()) / part;
    column.tail(way.size()) += (body_numbers(own_robot().state()) - reached.numbers) / part;
    return true;
  };
  const VectorX ahead = free_part(kDifference);
  if (ahead == all) return add(kDifference, state, all);
  if (free_part(-kDifference) == all) return add(-kDifference, state, all);
  return add(kDifference, state, ahead) &&
         add(-kDifference, VectorX::Zero(state.size()), all - ahead);
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

}  // namespace sinew::estimate
