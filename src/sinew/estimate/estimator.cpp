#include "sinew/estimate/estimator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "sinew/core/whole.hpp"
#include "sinew/estimate/equilibrium_filter.hpp"
#include "sinew/estimate/estimator_model.hpp"
#include "sinew/estimate/motion_filter.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/run.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensors.hpp"

namespace sinew::estimate {

namespace {

constexpr double kNever = -1.0;
// The iterated filter ends when the estimate moves by less than this fraction of its standard
// deviation: in an equilibrium, and in a step.
constexpr double kSettled = 1e-3;
constexpr double kSettledStep = 0.1;
constexpr int kMaxSettling = 10;
// Components of a direction up to this size are omitted from its description.
constexpr double kUnspoken = 0.1;

std::unique_ptr<EstimatorFilter> make_filter(const EstimatorModel& model, int threads) {
  if (model.robot->step().integrator == mechanics::Integrator::quasi_static) {
    return std::make_unique<EquilibriumFilter>(model, threads);
  }
  return std::make_unique<MotionFilter>(model, threads);
}

std::string spell(const VectorX& direction, const std::vector<std::string>& names) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(direction.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::stable_sort(order, std::greater{},
                           [&](Eigen::Index k) { return std::abs(direction[k]); });
  std::string text;
  const double sign = direction[order.front()] < 0.0 ? -1.0 : 1.0;
  for (const Eigen::Index k : order) {
    const double part = sign * direction[k];
    if (std::abs(part) <= kUnspoken) continue;
    text += fmt::format("{}{:.2g} {}",
                        text.empty() ? ""
                        : part < 0.0 ? " - "
                                     : " + ",
                        std::abs(part), names[static_cast<std::size_t>(k)]);
  }
  return text;
}

}  // namespace

std::string_view estimator_status_name(EstimatorStatus status) {
  static constexpr std::array<std::string_view, kEstimatorStatuses> kNames = {
      "not-started", "estimating", "unobservable", "sensors-lost", "no-equilibrium"};
  return kNames[static_cast<std::size_t>(status)];
}

Estimator::Estimator(const EstimatorModel& model, const model::Model& plant, int threads)
    : model_(model), plant_(plant), filter_(make_filter(model, threads)) {
  forget();
}

Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;

VectorX Estimator::mean() const { return filter_->mean(); }
MatrixX Estimator::covariance() const { return filter_->covariance(); }
VectorX Estimator::deviation() const { return filter_->covariance().diagonal().cwiseSqrt(); }
const sim::Simulation& Estimator::robot() const { return filter_->robot(); }

void Estimator::begin(const run::Run& run) {
  filter_->restart(run);
  forget();
}

void Estimator::forget() {
  used_.assign(model_.sensors.size(), kNever);
  silent_.assign(model_.sensors.size(), 0.0);
  dropped_ = started_ = 0.0;
  observe();
}

void Estimator::correct(const run::Run& run) {
  const double time_step = plant_.step().time_step;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const EstimatorSensor& sensor = model_.sensors[k];
    const auto size = static_cast<Eigen::Index>(sensor.size);
    const Eigen::Index own = std::exchange(first, first + size);
    const sense::Channel& channel = run.instruments.get<sense::Sensors>().channel(sensor.index);
    if (!channel.fresh() || (channel.received() && channel.time() == used_[k])) continue;
    const int late = whole<int>(std::round((run.time() - channel.time()) / time_step), 0);
    used_[k] = channel.time();
    if (late > model_.lags) {
      dropped_ += 1.0;
      continue;
    }
    const int lag = late;
    if (!filter_->knows(lag)) continue;
    const VectorX said = Eigen::Map<const VectorX>(channel.value().data(), size);
    const VectorX innovation = model_.difference(k, said, filter_->path(lag).segment(own, size)) -
                               filter_->beyond_path(lag).segment(own, size);
    filter_->correct(lag, own, innovation,
                     VectorX::Constant(size, sensor.deviation * sensor.deviation));
    started_ = 1.0;
  }
}

void Estimator::note_silence(const run::Run& run) {
  for (std::size_t k = 0; k < silent_.size(); ++k) {
    const EstimatorSensor& sensor = model_.sensors[k];
    const sense::Channel& channel = run.instruments.get<sense::Sensors>().channel(sensor.index);
    const double age = run.time() - (channel.has_value() ? channel.time() : 0.0);
    const bool late =
        age > sensor.delay + kSilentPeriods * sensor.period + sense::Channel::kSameTime;
    const bool old = channel.has_value() && !channel.valid(run.time());
    silent_[k] = late || old ? 1.0 : 0.0;
  }
}

// Samples of lost sensors carry no information.
void Estimator::observe() {
  VectorX variance(model_.readings());
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const EstimatorSensor& sensor = model_.sensors[k];
    const auto size = static_cast<Eigen::Index>(sensor.size);
    const double own = sensor.deviation * sensor.deviation;
    variance.segment(first, size).setConstant(silent_[k] != 0.0 ? kInfinity : own);
    first += size;
  }
  observability_ = filter_->observability(variance);
}

// Calls predictor(round) for a path about the present estimate, and corrects with all samples of
// the step again, until the estimate has converged. The predictor returns whether the robot
// succeeded.
template <class Predictor>
void Estimator::iterate(const run::Run& run, int rounds, double settled, Predictor&& predictor) {
  const std::vector<double> used = used_;
  const double dropped = dropped_;
  for (int round = 0; round < rounds; ++round) {
    const VectorX before = filter_->mean();
    const bool succeeded = predictor(round);
    if (round > 0 && !succeeded) break;  // the last estimate is kept
    used_ = used;
    dropped_ = dropped;
    correct(run);
    const VectorX moved = filter_->mean() - before;
    if (!succeeded || moved.cwiseQuotient(deviation()).cwiseAbs().maxCoeff() < settled) {
      break;
    }
  }
  note_silence(run);
  observe();
}

void Estimator::advance(const run::Run& run) {
  const auto predictor = [&](int round) {
    if (round > 0) return filter_->repeat(run);
    filter_->advance(run, plant_.step().time_step);
    return !filter_->failed();
  };
  iterate(run, filter_->iterates() ? kMaxSettling : 1, kSettledStep, predictor);
}

void Estimator::settle(const run::Run& run) {
  filter_->begin_settling();
  iterate(run, kMaxSettling, kSettled, [&](int) { return filter_->settle(run); });
}

EstimatorStatus Estimator::status() const {
  if (filter_->failed()) return EstimatorStatus::no_equilibrium;
  if (std::ranges::find(silent_, 1.0) != silent_.end()) return EstimatorStatus::sensors_lost;
  if (started_ == 0.0) return EstimatorStatus::not_started;
  return observability_.singular_values.minCoeff() < estimate::Observability::kUnobservable
             ? EstimatorStatus::unobservable
             : EstimatorStatus::estimating;
}

std::vector<std::string> Estimator::lost() const {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < silent_.size(); ++k) {
    if (silent_[k] == 0.0) continue;
    names.push_back(
        sense::sensors_of(plant_)[static_cast<std::size_t>(model_.sensors[k].index)].name);
  }
  return names;
}

std::vector<std::string> Estimator::unobservable() const {
  std::vector<std::string> words;
  const VectorX& values = observability_.singular_values;
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (values[k] >= estimate::Observability::kUnobservable) continue;
    words.push_back(fmt::format("{} (singular value {:.2g})",
                                spell(observability_.directions.col(k), model_.component_names()),
                                values[k]));
  }
  return words;
}

std::string Estimator::message() const {
  switch (status()) {
    case EstimatorStatus::no_equilibrium:
      return fmt::format("the robot of '{}' found no equilibrium{}{}", model_.name,
                         filter_->reason().empty() ? "" : ": ", filter_->reason());
    case EstimatorStatus::sensors_lost:
      return fmt::format("silent: {}", fmt::join(lost(), ", "));
    case EstimatorStatus::unobservable:
      return fmt::format("the prior decides: {}", fmt::join(unobservable(), ", "));
    default:
      return {};
  }
}

// Calls visitor(number) for every double.
template <class Self, class Visitor>
void Estimator::visit_memory(Self& self, Visitor&& visitor) {
  visitor(self.started_);
  visitor(self.dropped_);
  for (auto& number : self.used_) visitor(number);
  for (auto& number : self.silent_) visitor(number);
}

void Estimator::save(std::vector<double>& memory) const {
  visit_memory(*this, [&](double number) { memory.push_back(number); });
  filter_->save(memory);
}

bool Estimator::load(std::span<const double>& memory) {
  bool good = true;
  visit_memory(*this, [&](double& number) {
    good = good && !memory.empty();
    if (!good) return;
    number = memory.front();
    memory = memory.subspan(1);
  });
  if (!good || !filter_->load(memory)) return false;
  observe();
  return true;
}

}  // namespace sinew::estimate
