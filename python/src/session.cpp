#include "session.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include "sinew/core/usual_range.hpp"
#include "sinew/mechanics/body.hpp"
#include "sinew/mechanics/body_model.hpp"
#include "sinew/mechanics/capabilities.hpp"
#include "sinew/model/model.hpp"
#include "sinew/run/inputs.hpp"
#include "sinew/run/state.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/sim/watched.hpp"
#include "sinew/world/world.hpp"

#include "errors.hpp"

namespace sinew::python {

namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kSignalInterval = std::chrono::milliseconds(50);

// While the result exists, steps and solvers check regularly for Ctrl-C, which ends them.
sim::Watched look_for_signals(sim::Simulation& simulation) {
  return {simulation, [due = Clock::now() + kSignalInterval](const run::StepProgress&) mutable {
            if (Clock::now() < due) return;
            const pybind11::gil_scoped_acquire lock;
            if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
            due = Clock::now() + kSignalInterval;
          }};
}

// Python may have many simulations, such as environments. A simulation needs its factor only in a
// step.
void lend_factors(sim::Simulation& simulation) { simulation.world().bodies().release(); }

// @param category a class of sinew.errors.
void issue_warning(const std::string& message, const char* category = "SinewWarning") {
  const pybind11::object kind = pybind11::module_::import("sinew.errors").attr(category);
  if (PyErr_WarnEx(kind.ptr(), message.c_str(), 1) != 0) throw pybind11::error_already_set();
}

}  // namespace

mechanics::Tangent to_tangent(const std::string& word, const std::string& argument) {
  if (const auto tangent = mechanics::tangent_of(word)) return *tangent;
  throw Error(ErrorKind::unknown_choice, {.item = argument},
              fmt::format("there is no tangent '{}'", word),
              "use 'exact', 'projected' or 'corotated'");
}

const std::string& SavedState::bytes() const {
  if (bytes_.empty() && state_ != nullptr) bytes_ = sim::format_state(*state_, *model_);
  return bytes_;
}

const run::State* SavedState::of(const model::Model& model) const {
  if (state_ == nullptr || model_->fingerprint() != model.fingerprint()) return nullptr;
  return state_.get();
}

std::int64_t SavedState::steps() const {
  return state_ != nullptr ? state_->steps : sim::read_state_header(bytes_, "state").steps;
}

Session::Use::Use(const Session& session) : session_(session) {
  if (session_.busy_.exchange(true, std::memory_order_acquire)) throw SimulationBusy{};
}

Session::Use::~Use() { session_.busy_.store(false, std::memory_order_release); }

Session::Session(std::shared_ptr<const LoadedRobot> robot, int threads)
    : robot_(std::move(robot)),
      simulation_(robot_->robot.model, threads),
      observables_(simulation_) {
  observables_.number(observables_.find("numerical_loss"));  // it counts from the first read
  if (const auto* first = robot_->robot.first_controller()) attach(first->settings, first->name);
}

std::shared_ptr<Session> Session::clone() const {
  const Use use(*this);
  auto other = std::make_shared<Session>(robot_, simulation_.threads());
  if (other->controller_) other->detach(*other->controller_);
  other->simulation_.set_inputs(simulation_.inputs());
  if (controller_) other->attach(controller_->law->all_settings(), controller_->name);
  other->simulation_.restore(simulation_.state());
  other->steps_ = simulation_.steps();
  return other;
}

void Session::check_loads() const {
  for (int i = 0; i < simulation_.bodies(); ++i) {
    const auto* body = mechanics::as<const mechanics::TakesForces>(simulation_.body(i));
    if (body == nullptr || body->external_forces().allFinite()) continue;
    throw Error(ErrorKind::not_finite,
                {.item = fmt::format("body('{}').external_forces", model().body(i).name())},
                "a force is not a finite number", "write finite forces in N");
  }
}

void Session::advance(std::int64_t count, sim::OnFailure on_failure, sim::CableWatch* cables) {
  if (count < 0) {
    throw Error(ErrorKind::out_of_range, {.item = "step(n)"}, fmt::format("n is {}", count),
                "give zero or more steps; reset() goes back to the start");
  }
  const Use use(*this);
  check_loads();
  const sim::Watched watched = look_for_signals(simulation_);
  for (std::int64_t done = 0; done < count;) {
    {
      const pybind11::gil_scoped_release release;
      const auto pause = Clock::now() + kSignalInterval;
      do {
        simulation_.step(on_failure);
        if (cables != nullptr) cables->after_step();
        note_status();
        steps_.store(simulation_.steps(), std::memory_order_relaxed);
        ++done;
      } while (done < count && Clock::now() < pause);
    }
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
  }
  lend_factors(simulation_);
  warn();
  constexpr std::int64_t kMany = 10;
  if (count >= kMany) warn_units();
}

void Session::advance_unlocked(std::int64_t count, const std::function<bool()>& ended) {
  const Use use(*this);
  check_loads();
  for (std::int64_t done = 0; done < count; ++done) {
    simulation_.step();
    note_status();
    steps_.store(simulation_.steps(), std::memory_order_relaxed);
    if (ended()) break;
  }
  lend_factors(simulation_);
}

void Session::note_status() {
  const run::StepStatus status = simulation_.report().status;
  if (!run::is_flagged(status)) return;
  Flagged& flagged = flagged_[status];
  if (flagged.steps++ == 0) flagged.first = simulation_.time();
}

void Session::warn() {
  for (auto& [status, flagged] : flagged_) {
    if (std::exchange(flagged.warned, true)) continue;
    const std::string message = fmt::format(
        "the step to t = {:g} s is {}; {}", flagged.first, run::step_status_name(status),
        run::step_status_remedy(status, simulation_.model().step()));
    issue_warning(message, "StepWarning");
  }
}

void Session::note_pressure(const std::string& what, const model::Signal& signal) {
  constexpr int kSamples = 64;
  double& largest = pressures_[what].largest;
  for (int k = 0; k <= kSamples; ++k) {
    largest = std::max(largest, std::abs(signal.value(signal.end_time() * k / kSamples)));
  }
}

void Session::warn_units() {
  const UsualRange& range = *usual_range(Usual::pressure);
  for (auto& [what, told] : pressures_) {
    if (told.warned || !is_unusual(range, told.largest)) continue;
    told.warned = true;
    const std::string message = unusual_notice(range, told.largest, {}, {.item = what}).text();
    issue_warning(message);
  }
}

void Session::warn_cables(const sim::CableWatch& cables) {
  for (const Notice& notice : cables.notices()) {
    const std::string what =
        fmt::format("{} {}", notice_kind_name(notice.kind), notice.place.text());
    if (notice.level == NoticeLevel::remark || !told_of_cables_.insert(what).second) continue;
    issue_warning(notice.text());
  }
}

void Session::warn_strains(const scene::StrainWatch& strains) {
  for (const Notice& notice : strains.notices()) {
    if (told_laws_.insert(notice.place.item).second) issue_warning(notice.text());
  }
}

statics::StaticReport Session::solve_static(const statics::StaticSettings& settings) {
  warn_units();
  const Use use(*this);
  check_loads();
  const sim::Watched watched = look_for_signals(simulation_);
  statics::StaticReport report;
  {
    const pybind11::gil_scoped_release release;
    report = simulation_.solve_static(settings);
    lend_factors(simulation_);
  }
  scene::StrainWatch strains(robot().robot);
  strains.see(simulation_);
  warn_strains(strains);
  return report;
}

statics::Path Session::follow_path(const statics::PathSettings& settings,
                                   const std::function<void()>& visit) {
  const Use use(*this);
  const sim::Watched watched = look_for_signals(simulation_);
  const pybind11::gil_scoped_release release;
  return simulation_.follow_path(settings, visit);
}

void Session::reset() {
  const Use use(*this);
  for (int i = 0; i < simulation_.bodies(); ++i) {
    auto* body = mechanics::as<mechanics::TakesForces>(simulation_.body(i));
    if (body != nullptr) body->external_forces().setZero();
    auto* made = mechanics::as<mechanics::ScalesStiffness>(simulation_.body(i));
    if (made != nullptr) made->set_stiffness_factor(1.0);
  }
  simulation_.reset();
  flagged_.clear();
  told_laws_.clear();
  steps_ = 0;
}

SavedState Session::state() const {
  const Use use(*this);
  return {std::make_shared<const run::State>(simulation_.state()), simulation_.shared_model()};
}

void Session::restore(const SavedState& state) {
  const Use use(*this);
  if (const run::State* known = state.of(simulation_.model())) {
    simulation_.restore(*known);
  } else {
    sim::parse_state(simulation_, state.bytes(), "state");
  }
  steps_ = simulation_.steps();
}

void Session::load_state(const std::filesystem::path& path) {
  const Use use(*this);
  sim::load_state(simulation_, path);
  steps_ = simulation_.steps();
}

void Session::save_state(const std::filesystem::path& path) const {
  const Use use(*this);
  sim::save_state(simulation_, path);
}

sim::Linearisation Session::linearise(const sim::LinearisationChoice& choice) {
  const Use use(*this);
  check_loads();
  const pybind11::gil_scoped_release release;
  return sim::linearise(simulation_, choice);
}

sim::Linearisation Session::last_linearisation() {
  const Use use(*this);
  return sim::last_linearisation(simulation_);
}

std::shared_ptr<AttachedController> Session::attach(const control::ControllerSettings& settings,
                                                    std::string name) {
  const Use use(*this);
  if (controller_) {
    throw Error(ErrorKind::actuator_owned, {.item = "InverseController"},
                controller_->name.empty()
                    ? "another controller is attached to this simulation"
                    : fmt::format("the scene's controller '{}' is attached", controller_->name),
                "detach it first: sim.detach()");
  }
  auto made = std::make_shared<AttachedController>();
  made->name = std::move(name);
  made->law = control::make_controller(simulation_, settings);
  controller_ = made;
  return made;
}

std::optional<control::ControllerSettings> Session::lend_controller() {
  if (!controller_) return std::nullopt;
  controller_->law->detach();
  return controller_->law->all_settings();
}

void Session::take_back(bool same, const std::string& name,
                        std::unique_ptr<control::TargetController> law) {
  if (controller_ && law && same) {
    controller_->law = std::move(law);
    return;
  }
  if (controller_) controller_->attached = false;
  controller_.reset();
  if (!law) return;
  controller_ = std::make_shared<AttachedController>();
  controller_->name = name;
  controller_->law = std::move(law);
}

void Session::detach(AttachedController& controller) {
  const Use use(*this);
  controller.law->detach();
  controller.attached = false;
  if (controller_.get() == &controller) controller_.reset();
}

}  // namespace sinew::python
