#include "sinew/control/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/effector.hpp"
#include "sinew/core/error.hpp"
#include "sinew/core/rotation.hpp"
#include "sinew/core/whole.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/actuation.hpp"
#include "sinew/sense/channel.hpp"
#include "sinew/sense/sensor_set.hpp"
#include "sinew/sense/sensor_source.hpp"
#include "sinew/sense/sensors.hpp"
#include "sinew/sim/controlled_response.hpp"
#include "sinew/sim/simulation.hpp"

namespace sinew::control {

namespace {

// Limits hold effectors back if they prevent this part of the requested motion.
constexpr double kHeldBack = 1e-2;
// Age of a sample that does not exist.
constexpr double kNever = -1.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// A marker measures a point, an orientation sensor a rotation.
void check_kind(const sense::SensorModel& sensor, const constraint::Effector& effector) {
  const bool turns = effector.kind() == constraint::EffectorKind::orientation;
  if (sensor.source->effector_kind() == effector.kind()) return;
  throw Error(
      ErrorKind::wrong_type, {.item = "sensor '" + sensor.name + "'"},
      fmt::format("the effector '{}' is {}, and the sensor is of type {}", effector.name(),
                  turns ? "an orientation" : "a point", sensor.kind),
      fmt::format("measure the effector by a sensor of type {}", turns ? "orientation" : "marker"));
}

// Time between two samples of a healthy sensor.
double period_of(const sense::SensorModel& sensor, double time_step) {
  return sensor.channel.rate > 0.0 ? std::max(1.0 / sensor.channel.rate, time_step) : time_step;
}

void check_rate(const sense::SensorModel& sensor, double time_step, double timeout) {
  const double period = period_of(sensor, time_step);
  if (period <= timeout + sense::Channel::kSameTime) return;
  throw Error(ErrorKind::out_of_range, {.item = "sensor '" + sensor.name + "'"},
              fmt::format("a sample comes every {:g} s, and the closed loop holds its commands "
                          "when one is {:g} s late",
                          period, timeout),
              "give the controller a longer timeout, or the sensor a higher rate");
}

void check_number(const char* name, double value, bool good, const char* remedy) {
  if (good && std::isfinite(value)) return;
  throw Error(ErrorKind::out_of_range, {.item = "closed loop"},
              fmt::format("{} is {:g}", name, value), remedy);
}

void check_loop(const model::Model& model, const TargetSettings& settings,
                const ClosedLoopSettings& own) {
  if (settings.tasks.empty()) {
    throw Error(ErrorKind::no_effectors, {.item = "closed loop"}, "there is no effector to steer",
                "name at least one effector and its target");
  }
  check_number("gain", own.gain, own.gain > 0.0, "give 1/s, above 0");
  check_number("integral", own.integral, own.integral >= 0.0, "give 1/s^2, 0 or more");
  check_number("timeout", own.timeout, own.timeout > 0.0, "give s, above 0");
  if (own.sensors.size() != settings.tasks.size()) {
    throw Error(
        ErrorKind::wrong_length, {.item = "closed loop"},
        fmt::format("{} sensors for {} effectors", own.sensors.size(), settings.tasks.size()),
        "give one sensor for each effector");
  }
  for (std::size_t t = 0; t < settings.tasks.size(); ++t) {
    const sense::SensorModel& sensor = sense::sensors_of(model).at(at(own.sensors[t]));
    check_kind(sensor, model.effector(settings.tasks[t].effector));
    check_rate(sensor, model.step().time_step, own.timeout);
  }
}

Vector3 value_of(const sense::Channel& sensor) { return Vector3(sensor.value().data()); }

}  // namespace

ClosedLoop::ClosedLoop(sim::Simulation& simulation, TargetSettings settings, ClosedLoopSettings own)
    : TargetController(simulation, std::move(settings)), own_(std::move(own)) {
  const model::Model& model = simulation_.model();
  check_loop(model, settings_, own_);
  time_step_ = model.step().time_step;
  std::vector<double> weights;
  double longest = 0.0;
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    const EffectorTask& task = settings_.tasks[t];
    first_.push_back(std::ssize(weights));
    for (int k = 0; k < model.effector(task.effector).row_count(); ++k) {
      weights.push_back(task.weight_by_priority(k));
    }
    const sense::ChannelSettings& channel = sense::sensors_of(model)[at(own_.sensors[t])].channel;
    longest = std::max(longest, channel.delay + own_.timeout);
  }
  weights_ = Eigen::Map<VectorX>(weights.data(), std::ssize(weights));
  integral_.setZero(weights_.size());
  foreseen_.setZero(weights_.size(),
                    whole_count<Eigen::Index>(std::ceil(longest / time_step_) + 2.0, 1e6,
                                              "steps between a motion and its measurement",
                                              "shorten the delay or the timeout"));
  commands_.setZero(std::ssize(settings_.actuators));
  silent_.setZero(std::ssize(settings_.tasks));
  simulation_.attach(*this, settings_.actuators);
  attached_ = true;
}

ClosedLoop::~ClosedLoop() { ClosedLoop::detach(); }

void ClosedLoop::detach() {
  if (attached_) simulation_.detach(*this);
  attached_ = false;
}

// Updates silent_; returns whether any sensor is silent now.
bool ClosedLoop::note_silence() {
  const double now = simulation_.time();
  for (Eigen::Index t = 0; t < silent_.size(); ++t) {
    const sense::Channel& sensor =
        sense::sensors_of(simulation_).channel(own_.sensors[static_cast<std::size_t>(t)]);
    const double age = now - sensor.time();
    const double oldest = sensor.settings().delay + own_.timeout + sense::Channel::kSameTime;
    const bool good = sensor.valid(now) && age <= oldest;
    silent_[t] = good ? 0.0 : sensor.has_value() ? age : kNever;
  }
  return (silent_.array() != 0.0).any();
}

// Winches take lengths as commands; pressure regulators take pressures.
bool ClosedLoop::is_told_motion(std::size_t actuator) const {
  const auto& model = simulation_.model().actuators()[at(settings_.actuators[actuator])];
  return !model.kind->regulates_effort;
}

// Motion from a measured value of the effector to its target at a time.
Vector3 ClosedLoop::difference(int task, double time, const Vector3& from) const {
  const EffectorTask& asked = settings_.tasks[at(task)];
  const Vector3 to = asked.target.at(time);
  const auto& effector = simulation_.model().effector(asked.effector);
  if (effector.kind() == constraint::EffectorKind::point) return to - from;
  return rotation_vector(rotation_matrix(to) * rotation_matrix(from).transpose());
}

VectorX ClosedLoop::along(int task, const Vector3& difference) const {
  const auto& directions =
      simulation_.model().effector(settings_.tasks[at(task)].effector).directions();
  VectorX rows(std::ssize(directions));
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    rows[k] = directions[static_cast<std::size_t>(k)].dot(difference);
  }
  return rows;
}

double ClosedLoop::measured_error(int task) const {
  const sense::Channel& sensor = sense::sensors_of(simulation_).channel(own_.sensors[at(task)]);
  if (!sensor.has_value()) return std::numeric_limits<double>::quiet_NaN();
  VectorX rows = along(task, difference(task, simulation_.time(), value_of(sensor)));
  for (Eigen::Index k = 0; k < rows.size(); ++k) {
    if (!(settings_.tasks[at(task)].weight(k) > 0.0)) rows[k] = 0.0;
  }
  return rows.norm();
}

// Error e of the class, (rows,): from the predicted present position, which is the sample plus the
// motion commanded since it was taken, to the target.
VectorX ClosedLoop::error_now() const {
  VectorX error(weights_.size());
  const std::int64_t now = simulation_.steps(), kept = foreseen_.cols();
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    const auto task = static_cast<int>(t);
    const sense::Channel& sensor = sense::sensors_of(simulation_).channel(own_.sensors[t]);
    const VectorX rows = along(task, difference(task, simulation_.time(), value_of(sensor)));
    auto own = error.segment(first_[t], rows.size());
    own = rows;
    const double age = std::round((simulation_.time() - sensor.time()) / time_step_);
    for (std::int64_t n = now - whole<std::int64_t>(age, 0, std::min(now, kept)); n < now; ++n) {
      own -= foreseen_.col(n % kept).segment(first_[t], rows.size());
    }
  }
  return error;
}

// Motion of the targets in the step, (rows,).
VectorX ClosedLoop::lead() const {
  VectorX rows(weights_.size());
  const double now = simulation_.time();
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    const auto task = static_cast<int>(t);
    const VectorX own =
        along(task, difference(task, now + time_step_, settings_.tasks[t].target.at(now)));
    rows.segment(first_[t], own.size()) = own;
  }
  return rows;
}

// Limits of motions always admit the present motion, and let a slack cable be shorter than its path
// through the body by any length.
RateLimits ClosedLoop::limits() const {
  const auto count = std::ssize(settings_.actuators);
  RateLimits limits{VectorX(count), VectorX(count), VectorX(count), VectorX(count),
                    VectorX(count), VectorX(count), VectorX(count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const int index = settings_.actuators[static_cast<std::size_t>(k)];
    const model::ActuatorModel& model = simulation_.model().actuators()[at(index)];
    const model::ActuatorState& state = simulation_.actuator(index);
    const run::Interval effort = run::reachable(model.effort, state.effort, time_step_);
    const run::Interval motion = run::reachable(model.motion, state.setpoint, time_step_);
    const bool pulls = model.kind->pulls_only;
    limits.effort[k] = state.effort;
    limits.motion[k] = state.motion;
    limits.effort_min[k] = pulls ? std::max(0.0, effort.min) : effort.min;
    limits.effort_max[k] = effort.max;
    limits.motion_min[k] = pulls && state.slack ? -std::numeric_limits<double>::infinity()
                                                : std::min(motion.min, state.motion);
    limits.motion_max[k] = std::max(motion.max, state.motion);
    limits.motion_scale[k] = model.motion_scale / simulation_.model().size();
  }
  return limits;
}

void ClosedLoop::command() {
  const Eigen::Index slot = simulation_.steps() % foreseen_.cols();
  if (note_silence()) {
    foreseen_.col(slot).setZero();
    status_ = ControllerStatus::holding;
    return;
  }
  const sim::ControlledResponse response =
      sim::controlled_response(simulation_, settings_.actuators);
  MatrixX w_ea(weights_.size(), commands_.size());
  for (std::size_t t = 0; t < settings_.tasks.size(); ++t) {
    const MatrixX& own = response.effectors[at(settings_.tasks[t].effector)];
    w_ea.middleRows(first_[t], own.rows()) = own;
  }
  const VectorX error = error_now();
  const VectorX wanted = lead() + time_step_ * (own_.gain * error + own_.integral * integral_);
  const RateChoice choice = choose_change(w_ea, response.actuators, wanted, weights_, limits());
  const VectorX moved = w_ea * choice.change;
  if (own_.integral > 0.0) {
    integral_ += time_step_ * error - (wanted - moved) / own_.gain;
  }
  foreseen_.col(slot) = moved;
  tell(choice.change, response.actuators);
  status_ = judge(choice, wanted, moved);
}

// Its commands did not change, so it foresees no motion.
void ClosedLoop::hold_back() {
  foreseen_.col((simulation_.steps() - 1) % foreseen_.cols()).setZero();
  status_ = ControllerStatus::held_back;
}

void ClosedLoop::tell(const VectorX& change, const MatrixX& w_aa) {
  const VectorX motion = w_aa * change;
  for (Eigen::Index k = 0; k < commands_.size(); ++k) {
    const int index = settings_.actuators[static_cast<std::size_t>(k)];
    const model::ActuatorModel& model = simulation_.model().actuators()[at(index)];
    const model::ActuatorState& state = simulation_.actuator(index);
    const bool motions = is_told_motion(static_cast<std::size_t>(k));
    const double wanted = motions ? state.motion + motion[k] : state.effort + change[k];
    const run::Interval may = motions ? run::reachable(model.motion, state.setpoint, time_step_)
                                      : run::reachable(model.effort, state.effort, time_step_);
    commands_[k] = std::clamp(wanted, may.min, may.max);
  }
  started_ = true;
  push_commands();
}

void ClosedLoop::push_commands() {
  for (std::size_t k = 0; k < settings_.actuators.size(); ++k) {
    const int index = settings_.actuators[k];
    const auto kind = is_told_motion(k) ? model::CommandKind::motion : model::CommandKind::effort;
    const model::Command command =
        started_
            ? model::Command{kind, model::Signal::constant(commands_[static_cast<Eigen::Index>(k)])}
            : simulation_.model().actuators()[at(index)].command;
    simulation_.command(index, command, this);
  }
}

ControllerStatus ClosedLoop::judge(const RateChoice& choice, const VectorX& wanted,
                                   const VectorX& moved) const {
  if (choice.conflict) return ControllerStatus::limits_conflict;
  bool reached = true;
  for (int t = 0; t < static_cast<int>(settings_.tasks.size()); ++t) {
    reached = reached && measured_error(t) <= settings_.tolerance;
  }
  if (reached) return ControllerStatus::on_target;
  const VectorX root = weights_.cwiseSqrt();
  const double missed = root.cwiseProduct(wanted - moved).norm();
  const bool held_back = missed > kHeldBack * root.cwiseProduct(wanted).norm();
  return choice.limited && held_back ? ControllerStatus::at_limits : ControllerStatus::moving;
}

std::string ClosedLoop::conflict() const {
  std::string text;
  for (Eigen::Index t = 0; t < silent_.size(); ++t) {
    if (silent_[t] == 0.0) continue;
    const int sensor = own_.sensors[static_cast<std::size_t>(t)];
    text += fmt::format("{}'{}' {}", text.empty() ? "" : ", ",
                        sense::sensors_of(simulation_.model())[at(sensor)].name,
                        silent_[t] == kNever ? std::string("has delivered nothing yet")
                                             : fmt::format("is silent for {:.3g} s", silent_[t]));
  }
  return text;
}

// The memory begins with started_ and the status.
template <class Self, class Visitor>
void ClosedLoop::visit_memory(Self& self, Visitor&& visitor) {
  for (auto& number : self.integral_) visitor(number);
  for (auto& number : self.foreseen_.reshaped()) visitor(number);
  for (auto& number : self.commands_) visitor(number);
  for (auto& number : self.silent_) visitor(number);
}

std::size_t ClosedLoop::memory_size() const {
  return static_cast<std::size_t>(2 + integral_.size() + foreseen_.size() + commands_.size() +
                                  silent_.size());
}

void ClosedLoop::save_memory(std::span<double> memory) const {
  memory[0] = started_ ? 1.0 : 0.0;
  memory[1] = static_cast<double>(status_);
  auto to = memory.begin() + 2;
  visit_memory(*this, [&](double number) { *to++ = number; });
}

void ClosedLoop::load_memory(std::span<const double> memory) {
  started_ = memory[0] != 0.0;
  status_ = controller_status_of(memory[1]);
  auto from = memory.begin() + 2;
  visit_memory(*this, [&](double& number) { number = *from++; });
  push_commands();
}

// Commands stay: after a reset they are those of the scene again, otherwise they hold the robot.
void ClosedLoop::forget() {
  started_ = false;
  status_ = ControllerStatus::not_started;
  visit_memory(*this, [](double& number) { number = 0.0; });
}

}  // namespace sinew::control
