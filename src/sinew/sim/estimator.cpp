#include "sinew/sim/estimator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/sim/estimator_model.hpp"
#include "sinew/sim/inputs.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/sensor_source.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/step_response.hpp"

namespace sinew::sim {

namespace {

constexpr double kSilentPeriods = 5.0;
constexpr double kNever = -1.0;
// The iterated filter ends where the estimate moves by less than this part of its deviation.
constexpr double kSettled = 1e-3;
constexpr int kMaxSettling = 10;
// Components of a direction that words leave out.
constexpr double kUnspoken = 0.1;

VectorX spread(const EstimatorModel& model, double UnknownForce::*number) {
  VectorX all(3 * std::ssize(model.unknowns));
  for (std::size_t k = 0; k < model.unknowns.size(); ++k) {
    all.segment<3>(3 * static_cast<Eigen::Index>(k)).setConstant(model.unknowns[k].*number);
  }
  return all;
}

Eigen::Index readings_of(const EstimatorModel& model) {
  return std::accumulate(
      model.sensors.begin(), model.sensors.end(), Eigen::Index{0},
      [](Eigen::Index sum, const auto& one) { return sum + static_cast<Eigen::Index>(one.size); });
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

std::vector<std::string> EstimatorModel::component_names() const {
  std::vector<std::string> names;
  for (const UnknownForce& unknown : unknowns) {
    for (const char* axis : {".x", ".y", ".z"}) names.push_back(unknown.name + axis);
  }
  return names;
}

Estimator::Estimator(const EstimatorModel& model, const Model& plant, int threads)
    : model_(model),
      plant_(plant),
      robot_(std::make_unique<Simulation>(model.robot, threads)),
      filter_(spread(model, &UnknownForce::prior), spread(model, &UnknownForce::walk), model.lags) {
  for (const UnknownForce& unknown : model.unknowns) {
    for (int axis = 0; axis < 3; ++axis) controlled_.push_back(unknown.first_actuator + axis);
  }
  forget();
}

Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;

VectorX Estimator::deviation() const { return filter_.covariance().diagonal().cwiseSqrt(); }

void Estimator::begin(const Run& run) {
  robot_->reset();
  keep_time(run);
  forget();
}

// The time of its robot is the run's.
void Estimator::keep_time(const Run& run) {
  if (robot_->steps() == run.steps) return;
  State state = robot_->state();
  state.steps = run.steps;
  robot_->restore(state);
}

void Estimator::forget() {
  filter_.restart();
  const Eigen::Index count = readings_of(model_), size = filter_.size();
  instants_.assign(static_cast<std::size_t>(model_.lags) + 1,
                   {false, VectorX::Zero(size), VectorX::Zero(count), MatrixX::Zero(count, size)});
  used_.assign(model_.sensors.size(), kNever);
  silent_.assign(model_.sensors.size(), 0.0);
  dropped_ = 0.0;
  started_ = stopped_ = false;
  reason_.clear();
  observe();
}

// Forces of scripts and hands are what is to be found.
Inputs Estimator::inputs_of(const Run& run) const {
  Inputs inputs = run.inputs();
  const std::vector<ActuatorState>& states = run.actuation.states();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].chosen) {
      inputs.commands[i] = {CommandKind::effort, Signal::constant(states[i].effort)};
    }
  }
  const auto force = filter_.mean();
  for (Eigen::Index k = 0; k < force.size(); ++k) {
    inputs.commands.push_back({CommandKind::effort, Signal::constant(force[k])});
  }
  std::vector<Signal> loads;
  for (const int load : model_.loads) loads.push_back(inputs.loads[static_cast<std::size_t>(load)]);
  inputs.loads = std::move(loads);
  for (BodyInputs& body : inputs.bodies) {
    body.external_forces.setZero();
    body.tether.reset();
  }
  return inputs;
}

// A run does not end because its estimator finds no equilibrium.
void Estimator::take_up(const Run& run, bool settles) {
  robot_->set_inputs(inputs_of(run));
  Instant& now = instants_.front();
  now.force = filter_.mean();
  stopped_ = false;
  reason_.clear();
  try {
    if (settles) {
      robot_->solve_static();
    } else {
      robot_->step();
    }
  } catch (const Error& error) {
    stopped_ = true;
    reason_ = error.message();
  }
  if (!settles && !stopped_ && robot_->report().status == StepStatus::not_in_equilibrium) {
    stopped_ = true;
  }
  now.known = !stopped_;
  if (now.known) remember();
  keep_time(run);
}

void Estimator::remember() {
  Instant& now = instants_.front();
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const std::size_t size = model_.sensors[k].size;
    robot_->read_sensor_truth(static_cast<int>(k), {now.readings.data() + first, size});
    first += static_cast<Eigen::Index>(size);
  }
  now.sensitivity = sensitivity();
}

MatrixX Estimator::sensitivity() const {
  const StepResponse response(*robot_, controlled_);
  const Model& robot = *model_.robot;
  MatrixX all(readings_of(model_), filter_.size());
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const EstimatorSensor& sensor = model_.sensors[k];
    const SensorSource* source = robot.sensors()[k].source.get();
    const auto row_of = [&](int actuator) {
      return robot.actuators()[static_cast<std::size_t>(actuator)].row;
    };
    auto own = all.middleRows(first, static_cast<Eigen::Index>(sensor.size));
    if (sensor.effector >= 0) {
      own = response.motions(robot.effector(sensor.effector).first_row(), 3);
    } else if (const auto* motion = dynamic_cast<const MotionSource*>(source)) {
      own = response.motions(row_of(motion->actuator()), 1);
    } else {
      const auto& effort = dynamic_cast<const EffortSource&>(*source);
      own = effort.factor() * response.effort(row_of(effort.actuator()));
    }
    first += own.rows();
  }
  return all;
}

// What takes the reading that is expected to the one that came.
VectorX Estimator::difference(const EstimatorSensor& sensor, const VectorX& said,
                              const VectorX& expected) const {
  const bool turns = sensor.effector >= 0 && model_.robot->effector(sensor.effector).kind() ==
                                                 constraint::EffectorKind::orientation;
  if (!turns) return said - expected;
  return rotation_vector(rotation_matrix(Vector3(said)) *
                         rotation_matrix(Vector3(expected)).transpose());
}

void Estimator::correct(const Run& run) {
  const double time_step = plant_.step().time_step;
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const EstimatorSensor& sensor = model_.sensors[k];
    const auto size = static_cast<Eigen::Index>(sensor.size);
    const Eigen::Index own = std::exchange(first, first + size);
    const Channel& channel = run.sensors.channel(sensor.index);
    if (!channel.fresh() || (channel.received() && channel.time() == used_[k])) continue;
    const auto lag = std::max(0LL, std::llround((run.time() - channel.time()) / time_step));
    used_[k] = channel.time();
    if (lag > filter_.lags()) {
      dropped_ += 1.0;
      continue;
    }
    const Instant& then = instants_[static_cast<std::size_t>(lag)];
    if (!then.known) continue;
    const MatrixX slope = then.sensitivity.middleRows(own, size);
    const VectorX said = Eigen::Map<const VectorX>(channel.value().data(), size);
    const VectorX innovation = difference(sensor, said, then.readings.segment(own, size)) -
                               slope * (filter_.mean(static_cast<int>(lag)) - then.force);
    filter_.correct(static_cast<int>(lag), slope, innovation,
                    VectorX::Constant(size, sensor.deviation * sensor.deviation));
    started_ = true;
  }
}

void Estimator::note_silence(const Run& run) {
  for (std::size_t k = 0; k < silent_.size(); ++k) {
    const EstimatorSensor& sensor = model_.sensors[k];
    const Channel& channel = run.sensors.channel(sensor.index);
    const double age = run.time() - (channel.has_value() ? channel.time() : 0.0);
    const bool late = age > sensor.delay + kSilentPeriods * sensor.period + Channel::kSameTime;
    const bool old = channel.has_value() && !channel.valid(run.time());
    silent_[k] = late || old ? 1.0 : 0.0;
  }
}

// Samples of lost sensors tell nothing.
void Estimator::observe() {
  const Instant& now = instants_.front();
  MatrixX sensitivity = now.sensitivity;
  if (!now.known) sensitivity.setZero();
  VectorX variance(sensitivity.rows());
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < model_.sensors.size(); ++k) {
    const EstimatorSensor& sensor = model_.sensors[k];
    const auto size = static_cast<Eigen::Index>(sensor.size);
    variance.segment(first, size).setConstant(sensor.deviation * sensor.deviation);
    if (silent_[k] != 0.0) sensitivity.middleRows(first, size).setZero();
    first += size;
  }
  observability_ = estimate::observability(sensitivity, variance, filter_.prior());
}

void Estimator::advance(const Run& run) {
  filter_.predict(plant_.step().time_step);
  std::rotate(instants_.begin(), instants_.end() - 1, instants_.end());  // as a range: no clang 14
  take_up(run, false);
  correct(run);
  note_silence(run);
  observe();
}

void Estimator::settle(const Run& run) {
  for (Instant& instant : instants_) instant.known = false;  // what was on its way is forgotten
  const estimate::RandomWalkFilter before = filter_;
  const std::vector<double> used = used_;
  for (int round = 0; round < kMaxSettling; ++round) {
    take_up(run, true);
    filter_ = before;
    used_ = used;
    correct(run);
    const VectorX moved = filter_.mean() - instants_.front().force;
    if (stopped_ || moved.cwiseQuotient(deviation()).cwiseAbs().maxCoeff() < kSettled) break;
  }
  note_silence(run);
  observe();
}

EstimatorStatus Estimator::status() const {
  if (stopped_) return EstimatorStatus::no_equilibrium;
  if (std::ranges::find(silent_, 1.0) != silent_.end()) return EstimatorStatus::sensors_lost;
  if (!started_) return EstimatorStatus::not_started;
  return observability_.singular_values.minCoeff() < estimate::Observability::kUnobservable
             ? EstimatorStatus::unobservable
             : EstimatorStatus::estimating;
}

std::vector<std::string> Estimator::lost() const {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < silent_.size(); ++k) {
    if (silent_[k] == 0.0) continue;
    names.push_back(plant_.sensors()[static_cast<std::size_t>(model_.sensors[k].index)].name);
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
                         reason_.empty() ? "" : ": ", reason_);
    case EstimatorStatus::sensors_lost:
      return fmt::format("silent: {}", fmt::join(lost(), ", "));
    case EstimatorStatus::unobservable:
      return fmt::format("the prior decides: {}", fmt::join(unobservable(), ", "));
    default:
      return {};
  }
}

// Visitor(number) of a double or a bool, Visitor(matrix) of all numbers of a matrix.
template <class Self, class Visitor>
bool Estimator::visit_memory(Self& self, Visitor&& visitor) {
  const auto each = [&](auto& matrix) {
    for (auto& number : matrix.reshaped()) visitor(number);
  };
  visitor(self.started_);
  visitor(self.stopped_);
  visitor(self.dropped_);
  for (auto& number : self.used_) visitor(number);
  for (auto& number : self.silent_) visitor(number);
  for (auto& instant : self.instants_) {
    visitor(instant.known);
    each(instant.force);
    each(instant.readings);
    each(instant.sensitivity);
  }
  return true;
}

void Estimator::save(std::vector<double>& memory) const {
  visit_memory(*this, [&](auto number) { memory.push_back(static_cast<double>(number)); });
  filter_.save(memory);
  const State state = robot_->state();
  State::visit(state, [&](std::string_view, const auto& numbers) {
    if constexpr (requires { numbers.size(); }) {
      memory.push_back(static_cast<double>(numbers.size()));
      memory.insert(memory.end(), numbers.begin(), numbers.end());
    } else {
      memory.push_back(numbers);
    }
  });
  memory.push_back(static_cast<double>(state.steps));
}

bool Estimator::load(std::span<const double>& memory) {
  bool good = true;
  const auto next = [&] {
    if (memory.empty()) good = false;
    if (!good) return 0.0;
    const double number = memory.front();
    memory = memory.subspan(1);
    return number;
  };
  visit_memory(*this, [&](auto& number) {
    using Number = std::remove_reference_t<decltype(number)>;
    number = static_cast<Number>(next());
  });
  if (!good || !filter_.load(memory)) return false;
  State state = robot_->state();
  State::visit(state, [&](std::string_view, auto& numbers) {
    if constexpr (requires { numbers.size(); }) {
      const double size = next();
      good = good && size >= 0.0 && size <= static_cast<double>(memory.size());
      if (!good) return;
      const auto count = static_cast<std::size_t>(size);
      numbers.assign(memory.begin(), memory.begin() + static_cast<std::ptrdiff_t>(count));
      memory = memory.subspan(count);
    } else {
      numbers = next();
    }
  });
  state.steps = static_cast<std::int64_t>(next());
  if (!good) return false;
  robot_->restore(state);
  reason_.clear();
  observe();
  return true;
}

}  // namespace sinew::sim
