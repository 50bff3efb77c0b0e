#include "robot_state.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sinew/control/inverse_controller.hpp"
#include "sinew/fem/of_elements.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/actuator.hpp"
#include "sinew/model/model.hpp"
#include "sinew/model/signal.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/statics/free_motion_error.hpp"

#include "troubles.hpp"

namespace sinew::viewer {

namespace {

using Json = nlohmann::json;
constexpr const char* kOwnController = "view";
// Of a motion that nothing resists: the largest displacement that is shown, relative to the robot's
// size, the smallest, relative to the largest, and the number of displacements.
constexpr double kShownMotion = 0.15;
constexpr double kLeastMotion = 0.1;
constexpr std::size_t kMostArrows = 60;

std::vector<std::pair<Vector3, Vector3>> sample(const std::vector<statics::BodyMotion>& motion,
                                                double size) {
  std::vector<std::pair<Vector3, Vector3>> all, some;
  for (const statics::BodyMotion& body : motion) {
    for (Eigen::Index i = 0; i < body.displacements.rows(); ++i) {
      const Vector3 by = body.displacements.row(i).transpose();
      if (by.norm() < kLeastMotion) continue;
      all.emplace_back(body.positions.row(i).transpose(), kShownMotion * size * by);
    }
  }
  const std::size_t stride = all.size() / kMostArrows + 1;
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

}  // namespace

RobotState::RobotState(scene::Robot robot, std::shared_ptr<sim::Simulation> simulation,
                       std::optional<scene::SceneController> first)
    : robot_(std::move(robot)),
      simulation_(std::move(simulation)),
      own_(first ? control::make_controller(*simulation_, first->settings) : nullptr),
      controller_(own_.get()),
      controller_name_(first ? first->name : std::string()),
      observables_(list_observables()),
      description_(describe(robot_, observables_)),
      playback_(*simulation_, observables_),
      frames_(*simulation_, observables_, description_),
      first_(std::move(first)) {}

RobotState::~RobotState() {
  release();
  if (followed_before_) simulation_->follow(*followed_before_);
}

void RobotState::follow() {
  followed_before_ = simulation_->follows();
  simulation_->follow();
}

sim::Observables RobotState::list_observables() {
  sim::Observables list(*simulation_);
  std::vector<int> effectors(simulation_->model().effectors().size());
  std::iota(effectors.begin(), effectors.end(), 0);  // any of them may get a target
  control::add_controller(
      list, [this] { return controller_; }, effectors);
  list.add({{"real_time_factor",
             "",
             {},
             run::ObservableKind::timing,
             {},
             "real_time_factor",
             {"real_time_factor"},
             {}}},
           [this](std::span<double> to) { to[0] = real_time_factor_; });
  return list;
}

void RobotState::observe(const std::string& name, control::TargetController* controller) {
  observing_ = true;
  controller_ = controller;
  controller_name_ = controller == nullptr ? "" : name;
}

std::pair<std::string, std::unique_ptr<control::TargetController>> RobotState::take_controller() {
  controller_ = nullptr;
  return {controller_name_, std::move(own_)};
}

void RobotState::step() {
  try {
    simulation_->step();
    ++shape_;
  } catch (const statics::FreeMotionError& error) {
    stop(error);
    stopped_->free_motion = sample(error.motion(), simulation_->model().size());
  } catch (const Error& error) {
    stop(error);
  }
}

void RobotState::stop(const Error& error) {
  stopped_ = StoppedRun{simulation_->steps() + 1,
                        std::string(error_kind_name(error.kind())),
                        error.what(),
                        error.remedy(),
                        {}};
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
  const model::ActuatorModel& actuator =
      simulation_->model().actuators()[static_cast<std::size_t>(index)];
  const std::optional<model::CommandKind> kind = actuator.kind_of(command.quantity);
  if (!kind) {
    throw Error(ErrorKind::wrong_actuator_type, {.item = command.actuator},
                fmt::format("a {} is not commanded by {}", actuator.kind->word, command.quantity),
                "use one of the actuator's quantities");
  }
  const model::Limits limits = *kind == model::CommandKind::motion   ? actuator.motion
                               : *kind == model::CommandKind::effort ? actuator.effort
                                                                     : model::Limits{};
  if (command.value < limits.min || command.value > limits.max) {
    throw Error(ErrorKind::out_of_range, {.item = command.actuator},
                fmt::format("{:g} is beyond the limits {:g} to {:g}", command.value, limits.min,
                            limits.max),
                "stay within the limits of the scene");
  }
  simulation_->command(index, {*kind, model::Signal::constant(command.value)});
  acting_.reset();
}

void RobotState::detach() {
  acting_.reset();
  controller_ = nullptr;
  own_.reset();
  controller_name_.clear();
}

void RobotState::attach(const std::string& name, const control::ControllerSettings& settings) {
  detach();
  own_ = control::make_controller(*simulation_, settings);
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
  acting_.reset();
  const int effector = simulation_->model().effector_index(target.effector);
  if (!target.position) {
    targets_.erase(target.effector);
    for (const scene::SceneController& controller : robot_.controllers) {
      if (controller.name != controller_name_) continue;
      const auto& tasks = controller.settings.targets.tasks;
      const auto found = std::ranges::find(tasks, effector, &control::EffectorTask::effector);
      if (found == tasks.end()) continue;
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
    control::TargetSettings settings;
    settings.tasks = {{effector, control::Target::fixed(*target.position), {1.0}}};
    attach(kOwnController, control::settings_for<control::InverseController>(settings, {}));
  } else {
    controller_->set_target(task_of(effector), control::Target::fixed(*target.position));
  }
  targets_[target.effector] = *target.position;
}

void RobotState::show(const RecordedState& recorded) {
  playback_.show(recorded);
  ++shape_;
}

void RobotState::pull(const Pull& pull) {
  const int body = simulation_->model().body_index(pull.body);
  const DisplaySurface& surface = description_.surfaces[static_cast<std::size_t>(body)];
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

std::shared_ptr<const Acting> RobotState::acting() {
  if (acting_) return acting_;
  Acting now{simulation_->inputs(), controller_name_, {}, targets_};
  for (run::BodyInputs& body : now.inputs.bodies) body.tether.reset();
  if (own_) now.settings = own_->all_settings();
  return acting_ = std::make_shared<const Acting>(std::move(now));
}

Moment RobotState::moment() { return {simulation_->state(), acting(), simulation_->time()}; }

void RobotState::go_back(const Moment& moment) {
  release();
  const std::shared_ptr<const Acting> then = moment.acting;
  if (then != acting_) {
    detach();
    simulation_->set_inputs(then->inputs);
    if (then->settings) attach(then->controller, *then->settings);
    targets_ = then->targets;
    acting_ = then;
  }
  simulation_->restore(moment.state);
  stopped_.reset();
  ++shape_;
}

std::shared_ptr<Frame> RobotState::frame(const FrameWishes& wishes, double real_time_factor) {
  real_time_factor_ = real_time_factor;
  std::shared_ptr<Frame> frame = frames_.make(wishes);
  frame->shape = shape_;
  if (pulled_) {
    const auto& body = *mechanics::as<mechanics::TakesForces>(simulation_->body(*pulled_));
    const Vector3 point = body.tether_point();
    const mechanics::Tether& tether = *body.tether();
    frame->pull = {point, tether.anchor, tether.stiffness * (tether.anchor - point).norm()};
  }
  return frame;
}

std::string RobotState::status_members() const {
  const model::Model& model = simulation_->model();
  Json commands = Json::object(), targets = Json::object();
  for (std::size_t i = 0; i < model.actuators().size(); ++i) {
    const model::ActuatorModel& actuator = model.actuators()[i];
    const model::ActuatorState& state = simulation_->actuator(static_cast<int>(i));
    commands[actuator.name] = {{"quantity", actuator.quantity(state.command.kind).name},
                               {"value", state.command.signal.value(simulation_->time())},
                               {"owned", state.owner != nullptr}};
  }
  for (const auto& [name, position] : targets_) {
    targets[name] = {position.x(), position.y(), position.z()};
  }
  Json status = {{"controller", controller_ ? Json(controller_name_) : Json(nullptr)},
                 {"commands", commands},
                 {"targets", targets},
                 {"troubles", list_troubles(*simulation_, controller_, controller_name_)},
                 {"stopped", nullptr}};
  if (stopped_) {
    status["stopped"] = {{"step", stopped_->step},
                         {"kind", stopped_->kind},
                         {"message", stopped_->message},
                         {"remedy", stopped_->remedy},
                         {"free_motion", Json::array()}};
    for (const auto& [at, by] : stopped_->free_motion) {
      status["stopped"]["free_motion"].push_back({at.x(), at.y(), at.z(), by.x(), by.y(), by.z()});
    }
  }
  return status.dump();
}

}  // namespace sinew::viewer
