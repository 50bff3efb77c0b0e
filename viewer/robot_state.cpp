#include "robot_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/constraint/cable.hpp"
#include "sinew/constraint/probe.hpp"
#include "sinew/fem/of_elements.hpp"
#include "sinew/inverse/inverse_controller.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/sim/actuator.hpp"
#include "sinew/sim/model.hpp"
#include "sinew/sim/signal.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/state.hpp"

namespace sinew::viewer {

namespace {

using Json = nlohmann::json;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kOwnController = "view";

/// A limit counts as reached within this part of the range.
constexpr double kAtLimit = 1e-6;

bool at(double value, double limit, double scale) {
  return std::isfinite(limit) &&
         std::abs(value - limit) <= kAtLimit * std::max(scale, std::abs(limit));
}

Json trouble(const char* level, const char* kind, const std::string& subject,
             const std::string& text) {
  return {{"level", level}, {"kind", kind}, {"subject", subject}, {"text", text}};
}

void add_limits(const sim::ActuatorModel& model, const sim::ActuatorState& state, Json& list) {
  const bool most = state.effort > 0.0 && at(state.effort, model.effort.max, 1e-3);
  if (most) {
    list.push_back(trouble("warning", "effort-limit", model.name,
                           fmt::format("{} is at its limit, {:.3g} {}", model.words().effort.name,
                                       model.effort.max, model.words().effort.unit)));
  }
  const double travel = state.motion * model.motion_scale;
  const bool far = at(travel, model.motion.max * model.motion_scale, 1e-4) ||
                   at(travel, model.motion.min * model.motion_scale, 1e-4);
  if (far && state.motion != 0.0) {
    list.push_back(trouble("warning", "motion-limit", model.name,
                           fmt::format("{} is at its limit, {:.3g} {}", model.words().motion.name,
                                       state.motion, model.words().motion.unit)));
  }
  if (state.slack) list.push_back(trouble("info", "slack", model.name, "the cable is slack"));
}

void add_controller(const inverse::InverseController& controller, const std::string& name,
                    Json& list) {
  const std::string kind(inverse::inverse_status_name(controller.status()));
  switch (controller.status()) {
    case inverse::InverseStatus::not_started:
    case inverse::InverseStatus::on_target:
    case inverse::InverseStatus::moving:
      break;
    case inverse::InverseStatus::rate_limited:
      list.push_back(trouble("info", "rate-limited", name, "on the way; rates are limited"));
      break;
    case inverse::InverseStatus::out_of_reach:
      list.push_back(trouble(
          "warning", "out-of-reach", name,
          fmt::format("the target is out of reach by {:.3g} mm", 1e3 * controller.error())));
      break;
    case inverse::InverseStatus::local_optimum:
      list.push_back(trouble("warning", "local-optimum", name,
                             fmt::format("no small change of efforts comes nearer than {:.3g} mm",
                                         1e3 * controller.error())));
      break;
    case inverse::InverseStatus::limits_conflict:
      list.push_back(trouble("error", "limits-conflict", name,
                             "limits contradict each other: " + controller.conflict()));
      break;
  }
}

}  // namespace

RobotState::RobotState(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
                       std::optional<scene::SceneController> first)
    : robot_(std::move(robot)),
      simulation_(std::move(simulation)),
      observables_(list_observables()),
      description_(describe(robot_, observables_)),
      first_(std::move(first)) {
  for (const auto& body : robot_.model->bodies()) {
    means_.push_back(fem::nodal_mean(body));
  }
  if (first_) attach(first_->name, first_->settings);
}

RobotState::~RobotState() { release(); }

sim::Observables RobotState::list_observables() {
  sim::Observables list(*simulation_);
  std::vector<int> effectors(simulation_->model().effectors().size());
  std::iota(effectors.begin(), effectors.end(), 0);  // any may get a target
  inverse::add_controller(
      list, [this] { return controller_; }, effectors);
  list.add({{"real_time_factor",
             "",
             {},
             sim::ObservableKind::timing,
             {},
             "real_time_factor",
             {"real_time_factor"},
             {}}},
           [this](std::span<double> to) { to[0] = real_time_factor_; });
  return list;
}

void RobotState::observe(const std::string& name, inverse::InverseController* controller) {
  observing_ = true;
  controller_ = controller;
  controller_name_ = controller == nullptr ? "" : name;
}

std::pair<std::string, std::unique_ptr<inverse::InverseController>> RobotState::take_controller() {
  controller_ = nullptr;
  return {controller_name_, std::move(own_)};
}

void RobotState::step() {
  try {
    simulation_->step();
    ++shape_;
  } catch (const Error& error) {
    stopped_ = StoppedRun{simulation_->steps() + 1, std::string(error_kind_name(error.kind())),
                          error.what(), error.remedy()};
  }
}

void RobotState::reset() {
  release();
  targets_.clear();
  detach();
  simulation_->reset();
  if (first_) attach(first_->name, first_->settings);
  stopped_.reset();
  ++shape_;
}

void RobotState::settle() {
  simulation_->solve_static();
  ++shape_;
}

void RobotState::command(const SetCommand& command) {
  const int index = simulation_->model().actuator_index(command.actuator);
  const sim::ActuatorModel& actuator =
      simulation_->model().actuators()[static_cast<std::size_t>(index)];
  const std::optional<sim::CommandKind> kind = actuator.kind_of(command.quantity);
  if (!kind) {
    throw Error(ErrorKind::wrong_actuator_type, {.item = command.actuator},
                fmt::format("a {} is not commanded by {}", actuator.words().type, command.quantity),
                "use one of the actuator's quantities");
  }
  const sim::Limits limits = *kind == sim::CommandKind::motion   ? actuator.motion
                             : *kind == sim::CommandKind::effort ? actuator.effort
                                                                 : sim::Limits{};
  if (command.value < limits.min || command.value > limits.max) {
    throw Error(ErrorKind::out_of_range, {.item = command.actuator},
                fmt::format("{:g} is beyond the limits {:g} to {:g}", command.value, limits.min,
                            limits.max),
                "stay within the limits of the scene");
  }
  simulation_->command(index, {*kind, sim::Signal::constant(command.value)});
}

void RobotState::detach() {
  controller_ = nullptr;
  own_.reset();
  controller_name_.clear();
}

void RobotState::attach(const std::string& name, const inverse::InverseSettings& settings) {
  detach();
  own_ = std::make_unique<inverse::InverseController>(*simulation_, settings);
  controller_ = own_.get();
  controller_name_ = name;
}

void RobotState::choose_controller(const std::optional<std::string>& name) {
  if (observing_) {
    throw Error(ErrorKind::not_in_this_version, {.item = "controller"},
                "the script that steps this robot chooses its controller",
                "attach or detach it in the script");
  }
  if (!name) return detach();
  if (first_ && first_->name == *name) return attach(*name, first_->settings);
  attach(*name, robot_.controller(*name).settings);
}

void RobotState::set_target(const SetTarget& target) {
  const int effector = simulation_->model().effector_index(target.effector);
  if (!target.position) {
    targets_.erase(target.effector);
    for (const scene::SceneController& controller : robot_.controllers) {
      if (controller.name != controller_name_) continue;
      const auto found =
          std::ranges::find(controller.settings.tasks, effector, &inverse::Task::effector);
      if (found == controller.settings.tasks.end()) continue;
      controller_->set_target(task_of(effector), found->target);
    }
    if (controller_name_ == kOwnController) detach();
    return;
  }
  if (observing_ && task_of(effector) < 0) {
    throw Error(ErrorKind::no_effectors, {.item = target.effector},
                "no controller of the script steers this effector",
                "attach one: sinew.InverseController(sim, {...})");
  }
  if (task_of(effector) < 0) {
    inverse::InverseSettings settings;
    settings.tasks = {{effector, inverse::Target::fixed(*target.position), {1.0}}};
    attach(kOwnController, settings);
  } else {
    controller_->set_target(task_of(effector), inverse::Target::fixed(*target.position));
  }
  targets_[target.effector] = *target.position;
}

void RobotState::check(const RecordedState& recorded) const {
  for (const auto& [index, numbers] : recorded.values) {
    const sim::Observable& one = observables_.list().at(index);
    const auto refuse = [&](const std::string& what) {
      throw Error(ErrorKind::malformed_file, {.item = one.name}, what,
                  "record the run again with this version");
    };
    if (numbers.size() != one.size()) {
      refuse(fmt::format("{} numbers are recorded, its scene has {}", numbers.size(), one.size()));
    }
    if (one.words.empty()) continue;
    for (const double number : numbers) {
      if (one.word(number).empty()) refuse(fmt::format("{} is recorded, which is no word", number));
    }
  }
}

void RobotState::put_body(const sim::Observable& what, const std::vector<double>& numbers,
                          sim::State& state) const {
  const int body = simulation_->model().body_index(what.owner);
  if (mechanics::as<const mechanics::HasPose>(simulation_->body(body)) != nullptr) return;
  const bool of_coordinates =
      mechanics::as<const mechanics::HasCoordinates>(simulation_->body(body)) != nullptr;
  if (what.quantity != (of_coordinates ? "coordinates" : "positions")) return;
  std::vector<double>& own = state.bodies[static_cast<std::size_t>(body)];
  std::ranges::fill(own, 0.0);  // a moment at rest
  std::ranges::copy(numbers, own.begin());
}

// A rigid body is recorded by its position and rotation.
void RobotState::put_poses(const RecordedState& recorded, sim::State& state) const {
  for (int body = 0; body < simulation_->bodies(); ++body) {
    const auto* rigid = mechanics::as<const mechanics::HasPose>(simulation_->body(body));
    if (rigid == nullptr) continue;
    const std::string& name = simulation_->body(body).model().name();
    const std::vector<double>* position = nullptr;
    const std::vector<double>* rotation = nullptr;
    for (const auto& [index, numbers] : recorded.values) {
      const sim::Observable& one = observables_.list()[index];
      if (one.kind != sim::ObservableKind::body || one.owner != name) continue;
      if (one.quantity == "position") position = &numbers;
      if (one.quantity == "rotation") rotation = &numbers;
    }
    if (position == nullptr || rotation == nullptr) continue;
    const std::vector<double>& q = *rotation;
    rigid->put_pose(Vector3(position->data()), Eigen::Quaterniond(q[0], q[1], q[2], q[3]),
                    state.bodies[static_cast<std::size_t>(body)]);
  }
}

// An actuator of a replay has the command that it had, whether a controller or the scene gave it.
void RobotState::put_actuator(const sim::Observable& what, double number, sim::State& state) {
  const int index = simulation_->model().actuator_index(what.owner);
  const auto place = static_cast<std::size_t>(index);
  const sim::ActuatorModel& actuator = simulation_->model().actuators()[place];
  if (what.quantity == "effort") state.efforts[static_cast<std::size_t>(actuator.row)] = number;
  if (what.quantity == "motion") state.motions[place] = state.setpoints[place] = number;
  for (const sim::CommandKind kind : sim::command_kinds(actuator)) {
    if (what.name != sim::command_name(actuator, kind) || !std::isfinite(number)) continue;
    simulation_->command(index, {kind, sim::Signal::constant(number)});
  }
}

void RobotState::show(const RecordedState& recorded) {
  check(recorded);
  observables_.release();
  sim::State state = simulation_->state();
  for (const auto& [index, numbers] : recorded.values) {
    const sim::Observable& one = observables_.list()[index];
    if (one.kind == sim::ObservableKind::body) {
      put_body(one, numbers, state);
      continue;
    }
    observables_.hold(index, numbers);
    if (one.kind == sim::ObservableKind::actuator) put_actuator(one, numbers.front(), state);
  }
  put_poses(recorded, state);
  state.volume_ratio = 1.0;  // not recorded
  state.steps = recorded.step;
  simulation_->restore(state);
  ++shape_;
}

void RobotState::pull(const Pull& pull) {
  const int body = simulation_->model().body_index(pull.body);
  const Surface& surface = description_.surfaces[static_cast<std::size_t>(body)];
  mechanics::Tether tether;
  for (std::size_t k = 0; k < 3; ++k) {
    const int vertex = pull.vertices[k];
    if (static_cast<std::size_t>(vertex) >= surface.nodes.size()) {
      throw Error(ErrorKind::index_out_of_range, {.item = "vertices"},
                  fmt::format("vertex {} of {}", vertex, surface.nodes.size()),
                  "name vertices of the surface");
    }
    tether.nodes[k] = surface.nodes[static_cast<std::size_t>(vertex)];
    tether.weights[k] = pull.weights[static_cast<Eigen::Index>(k)];
  }
  tether.anchor = pull.anchor;
  tether.stiffness = pull.stiffness;
  if (pulled_ && *pulled_ != body) release();
  fem::of_elements<mechanics::TakesForces>(simulation_->body(body)).set_tether(tether);
  pulled_ = body;
}

void RobotState::release() {
  if (pulled_) {
    mechanics::as<mechanics::TakesForces>(simulation_->body(*pulled_))->set_tether(std::nullopt);
  }
  pulled_.reset();
}

void RobotState::fill_signals(Frame& frame) {
  frame.signals.reserve(description_.signals.size());
  for (std::size_t k = 0; k < observables_.list().size(); ++k) {
    if (!is_signal(observables_.list()[k])) continue;
    const std::span<const double> numbers = observables_.read(k);
    frame.signals.insert(frame.signals.end(), numbers.begin(), numbers.end());
  }
}

void RobotState::fill_body(std::size_t index, const FieldChoice& wanted, BodyFrame& frame) {
  const mechanics::Body& body = simulation_->body(static_cast<int>(index));
  const Surface& surface = description_.surfaces[index];
  frame.positions.reserve(3 * surface.nodes.size());
  for (const NodeId node : surface.nodes) {
    for (int c = 0; c < 3; ++c) {
      frame.positions.push_back(static_cast<float>(body.positions()(node, c)));
    }
  }
  frame.fields.resize(wanted.size());
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    if (!wanted[f]) continue;
    const std::vector<double> nodal =
        list_fields()[f].values(body, *simulation_, means_[index].get());
    for (const NodeId node : surface.nodes) {
      frame.fields[f].push_back(static_cast<float>(nodal[static_cast<std::size_t>(node)]));
    }
  }
}

void RobotState::fill_points(Frame& frame) {
  const sim::Model& model = simulation_->model();
  const auto put = [](std::vector<float>& list, const Vector3& point) {
    for (int c = 0; c < 3; ++c) list.push_back(static_cast<float>(point[c]));
  };
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const constraint::Cable* cable = model.cable(static_cast<int>(i));
    if (cable == nullptr) continue;
    const Points points = cable->points(simulation_->configuration());
    for (Eigen::Index k = 0; k < points.rows(); ++k) put(frame.cables, points.row(k).transpose());
  }
  for (const auto& probe : model.probes()) {
    const Points marks = probe.marks(simulation_->configuration());
    for (Eigen::Index k = 0; k < marks.rows(); ++k) put(frame.probes, marks.row(k).transpose());
  }
  // Rotations are no points.
  const auto put_numbers = [&](std::vector<float>& list, std::size_t observable) {
    const bool point = observables_.list()[observable].unit == "m";
    const std::span<const double> numbers = observables_.read(observable);
    put(list, point ? Vector3(numbers[0], numbers[1], numbers[2]) : Vector3::Constant(kNone));
  };
  for (std::size_t k = 0; k < observables_.list().size(); ++k) {
    const sim::Observable& one = observables_.list()[k];
    if (one.kind == sim::ObservableKind::effector) put_numbers(frame.effectors, k);
    const bool target = one.kind == sim::ObservableKind::controller && one.quantity == "target";
    if (target) put_numbers(frame.targets, k);
  }
}

void RobotState::fill_contacts(Frame& frame) {
  for (const sim::ContactModel& contact : simulation_->model().contacts()) {
    std::vector<float>& values = frame.contacts.emplace_back();
    const auto put = [&](const auto& numbers) {
      for (Eigen::Index k = 0; k < numbers.size(); ++k) {
        values.push_back(static_cast<float>(numbers[k]));
      }
    };
    const auto numbers = [&](const char* name) {
      return observables_.read(observables_.find(contact.name + name));
    };
    using Pose = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
    const Eigen::Map<const Pose> pose(numbers(".pose").data());
    put(pose.col(3));
    put(Eigen::Quaterniond(Matrix3(pose.leftCols<3>())).coeffs());  // x, y, z, w
    const auto position = numbers(".points.position"), normal = numbers(".points.normal"),
               normal_force = numbers(".points.normal_force"),
               friction_force = numbers(".points.friction_force"), state = numbers(".points.state");
    values.reserve(7 * (1 + state.size()));
    for (std::size_t k = 0; k < state.size(); ++k) {
      using Vector = Eigen::Map<const Vector3>;
      put(Vector(&position[3 * k]));
      put(Vector3(normal_force[k] * Vector(&normal[3 * k]) + Vector(&friction_force[3 * k])));
      values.push_back(static_cast<float>(state[k]));
    }
  }
}

std::shared_ptr<const Frame> RobotState::frame(const FieldChoice& wanted, double real_time_factor) {
  real_time_factor_ = real_time_factor;
  observables_.refresh();
  auto frame = std::make_shared<Frame>();
  frame->step = static_cast<std::uint64_t>(simulation_->steps());
  frame->time = simulation_->time();
  frame->hash = simulation_->state().hash();
  frame->shape = shape_;
  fill_signals(*frame);
  frame->bodies.resize(description_.surfaces.size());
  for (std::size_t b = 0; b < frame->bodies.size(); ++b) fill_body(b, wanted, frame->bodies[b]);
  fill_points(*frame);
  fill_contacts(*frame);
  if (pulled_) {
    const auto& body = *mechanics::as<mechanics::TakesForces>(simulation_->body(*pulled_));
    const Vector3 point = body.tether_point();
    const mechanics::Tether& tether = *body.tether();
    frame->pull = {point, tether.anchor, tether.stiffness * (tether.anchor - point).norm()};
  }
  return frame;
}

std::string RobotState::status_members() const {
  const sim::Model& model = simulation_->model();
  Json commands = Json::object(), targets = Json::object(), troubles = Json::array();
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const sim::ActuatorModel& actuator = model.actuators()[i];
    const sim::ActuatorState& state = simulation_->actuator(static_cast<int>(i));
    commands[actuator.name] = {{"quantity", actuator.quantity(state.command.kind).name},
                               {"value", state.command.signal.value(simulation_->time())},
                               {"owned", state.owner != nullptr}};
    add_limits(actuator, state, troubles);
  }
  for (const auto& [name, position] : targets_) {
    targets[name] = {position.x(), position.y(), position.z()};
  }
  if (controller_) add_controller(*controller_, controller_name_, troubles);
  if (const sim::StepStatus step = simulation_->report().status; sim::is_flagged(step)) {
    troubles.push_back(trouble("warning", std::string(sim::step_status_name(step)).c_str(), "step",
                               fmt::format("this step is {}; {}", sim::step_status_name(step),
                                           sim::step_status_remedy(step))));
  }
  Json status = {{"controller", controller_ ? Json(controller_name_) : Json(nullptr)},
                 {"commands", commands},
                 {"targets", targets},
                 {"troubles", troubles},
                 {"stopped", nullptr}};
  if (stopped_) {
    status["stopped"] = {{"step", stopped_->step},
                         {"kind", stopped_->kind},
                         {"message", stopped_->message},
                         {"remedy", stopped_->remedy}};
  }
  return status.dump();
}

}  // namespace sinew::viewer
