// How Simulation solves the equation of one step, and what it makes of the solution.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/sim/folded_cable.hpp"
#include "sinew/sim/load_steps.hpp"
#include "sinew/sim/newton.hpp"
#include "sinew/sim/simulation.hpp"
#include "sinew/step/controller.hpp"

namespace sinew::sim {

namespace {

constexpr int kMostStepHalvings = 10;
// Of the robot's size: a point that is deeper in a surface after one linearisation, and is not
// pushed out, is not there by rounding.
constexpr double kMaxDepth = 1e-6;
// What quasi-static steps leave for the next one.
constexpr Lag kLag{0.1, 1e-3};
// Relative residuals above this are no equilibrium, whatever the loads: half of the forces of a
// slender robot are axial, and bend it by nothing when they are this little out of balance.
constexpr double kBalanced = 0.02;
// What a search with all means at hand may end with: friction of cables keeps Newton from settling.
constexpr double kSearched = 2e-5;
// A command that is missed by more than this of the robot's size was not reached.
constexpr double kReached = 1e-3;
// Commanded motions are made to this part of the robot's size.
constexpr double kMotionTolerance = 1e-5;
// Energy that came out of nothing, of the largest energy so far.
constexpr double kEnergyGain = 0.05;
// And of the work of all forces over the robot's size: less is rounding, as of a robot at rest.
constexpr double kNoEnergy = 1e-10;
// Iterations with the projected tangent, which end wherever a stable equilibrium is downhill.
constexpr int kMostDescents = 60;
// The smallest part of a quasi-static step.
constexpr double kLeastPart = 1.0 / 64.0;
constexpr int kIterationsOfPart = 25;
// A controller chooses where to go anew in every iteration, which need not settle: after this many
// its efforts are held. It has to keep up with a clock, too: a quasi-static step that it steers
// takes no parts, and as many iterations with held efforts, with either tangent.
constexpr int kSteeredIterations = 8;

}  // namespace

NewtonSettings Simulation::newton_settings(double time_step) const {
  const auto& settings = model_->step();
  const bool lags = !settings.dynamic() && !settings.tolerance;
  return {{step_weights(time_step), settings.tangent, model_->stiffening_widens(), true},
          settings.newton_tolerance(),
          std::min(settings.newton_tolerance(), kMotionTolerance),
          settings.max_iterations,
          model_->stiffening_constraints(),
          lags ? kLag : Lag{}};
}

NewtonSettings Simulation::settings_of_part(double time_step) const {
  NewtonSettings settings = newton_settings(time_step);
  settings.max_iterations = std::min(settings.max_iterations, kIterationsOfPart);
  return settings;
}

void Simulation::solve_equation(double time_step) {
  if (model_->step().method == Method::newton) {
    step_newton(time_step);
  } else {
    step_once(time_step);
  }
}

// One linear solution, and a look at what it left. In dynamics it is about where the velocities
// lead: a turn by an angle t is then followed to t^2, and not stretched.
void Simulation::step_once(double time_step) {
  if (model_->step().dynamic()) world_.drift(time_step);
  const auto stiffening = std::span<const int>(model_->stiffening_constraints());
  auto request = newton_settings(time_step).request;
  request.iterating = false;
  const auto linearise = [&] {
    world_.linearise(request);
    clock_.mark(Stage::assembly);
    world_.form_rows(effort_, stiffening);
    clock_.mark(Stage::compliance);
  };
  linearise();
  auto status = world_.condense();
  if (status != linalg::FactorStatus::singular && request.tangent == mechanics::Tangent::exact &&
      !world_.is_stable(status)) {
    request.tangent = mechanics::Tangent::projected;
    linearise();
    status = world_.condense();
  }
  clock_.mark(Stage::factorisation);
  if (status == linalg::FactorStatus::singular) {
    fail(ErrorKind::singular_matrix, "the stiffness matrix is singular",
         "fix a region of every body, or look for loose or crushed elements");
  }
  report_.law = world_.solve_step(*solver_, controller_, effort_, clock_);
  if (report_.law == LawStatus::failed) fail_law();
  report_.iterations = 1;
  move_soundly();
  clock_.mark(Stage::correction);
  require_outside();
  request.tangent = model_->step().tangent;
  request.iterating = true;
  linearise();
  report_.residual = world_.residual(effort_);
  report_.relative_residual = report_.residual / (world_.force_scale() + 1e-300);
  report_.violation = world_.violation(effort_);
}

void Simulation::fail_law() {
  if (!model_->contacts().empty()) fail_contacts();
  fail(ErrorKind::not_converged, "no efforts obey the law of this step",
       "loosen the limits of the actuators");
}

// Points that commanded motions leave nothing to give way are beyond any contact force.
void Simulation::require_outside() {
  if (model_->contacts().empty()) return;
  const double depth = world_.deepest_free_point(effort_);
  if (depth <= kMaxDepth * model_->size()) return;
  fail(ErrorKind::not_converged,
       fmt::format("a point would be {:.3g} m inside a surface, and no contact force can move it",
                   depth),
       "take a smaller time step, or command no motion that ends in the surface");
}

// Takes the motion, or the largest halving of it that inverts no element.
void Simulation::move_soundly() {
  const bool was_sound = volume_ratio_ > 0.0;
  report_.scale = 1.0;
  mechanics::MotionReport motion;
  for (int halving = 0; halving <= kMostStepHalvings; ++halving, report_.scale *= 0.5) {
    motion = world_.apply_motion(report_.scale);
    if (motion.finite) motion.volume = world_.smallest_volume();
    if (motion.finite && (motion.volume.ratio > 0.0 || !was_sound)) {
      volume_ratio_ = report_.smallest_volume_ratio = motion.volume.ratio;
      return;
    }
  }
  if (!motion.finite) {
    fail(ErrorKind::diverged, "the motion of this step is not finite or out of all proportion",
         "take a smaller time step, or check loads and material");
  }
  fail(ErrorKind::inverted_in_run,
       fmt::format("element {} would turn inside out (det F = {:.3g}) even at {:.2g} of the motion",
                   motion.volume.element, motion.volume.ratio, 2.0 * report_.scale),
       "take a smaller time step, change commands more slowly, or refine the mesh there");
}

void Simulation::take_report(const NewtonReport& result) {
  report_.law = result.law;
  report_.residual = result.residual;
  report_.relative_residual = result.relative_residual;
  report_.violation = result.violation;
  report_.iterations = result.iterations;
  report_.newton = result.status;
  report_.scale = 1.0;
  volume_ratio_ = report_.smallest_volume_ratio = result.motion.volume.ratio;
}

// What a controller chose last is what its actuators do in the rest of the step.
void Simulation::hold_efforts() {
  for (step::ActuatorBlock& block : world_.problem().actuators) {
    if (block.owned) block.hold_effort(effort_[static_cast<std::size_t>(block.row)]);
  }
}

// Whether a quasi-static step may end so, and be flagged. Of contacts there is no such thing as
// nearly: a point would be inside a surface. Forces may be as much out of balance as those of any
// step that a controller steers.
bool Simulation::is_usable(const NewtonReport& result) const {
  if (!result.motion.finite || !(result.motion.volume.ratio > 0.0)) return false;
  if (result.law == LawStatus::failed) return false;
  if (model_->contacts().empty()) return true;
  return result.relative_residual <= (controller_ == nullptr ? kSearched : kBalanced) &&
         result.violation <= kMotionTolerance * model_->size();
}

// Where a controller's choice leads nowhere its actuators keep the efforts of the last step. It
// remembers what it foresaw, and trusts its next choice less (see inverse::StepDamping).
NewtonReport Simulation::stay(double time_step) {
  std::vector<double> memory(controller_->memory_size());
  controller_->save_memory(memory);
  restore(state_before_);
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    if (actuators_[i].owner == nullptr) continue;
    world_.problem().actuators[i].hold_effort(actuators_[i].effort);
  }
  world_.begin_step(now_ - time_step, now_, effort_);
  NewtonReport result = newton(nullptr, newton_settings(time_step));
  if (result.status != NewtonStatus::converged) result = approach(time_step);
  if (result.status != NewtonStatus::converged) result = descend(time_step, kMostDescents);
  controller_->load_memory(memory);
  return result;
}

NewtonReport Simulation::newton(step::Controller* controller, const NewtonSettings& settings) {
  return solve_newton(world_, *solver_, controller, effort_, settings, clock_);
}

// Newton; where that finds nothing and there is no inertia to say where to go, along the loads and
// commands in parts, and last downhill.
void Simulation::step_newton(double time_step) {
  const bool dynamic = model_->step().dynamic(), steered = controller_ != nullptr;
  NewtonSettings settings = newton_settings(time_step);
  const int whole = settings.max_iterations, few = std::min(whole, kSteeredIterations);
  settings.max_iterations = steered ? few : whole;
  NewtonReport result = newton(controller_, settings);
  const auto goes_on = [&] {
    return result.status != NewtonStatus::converged && result.law != LawStatus::failed;
  };
  int tried = result.iterations;
  if (steered && goes_on()) {
    const LawStatus chosen = result.law;
    hold_efforts();
    settings.max_iterations = dynamic ? whole : few;
    result = newton(nullptr, settings);
    tried += result.iterations;
    if (!dynamic && goes_on()) {
      result = descend(time_step, few);
      tried += result.iterations;
    }
    if (!dynamic && goes_on() && !is_usable(result)) {
      result = stay(time_step);
      tried += result.iterations;
    }
    result.law = std::max(result.law, chosen);
  } else if (!dynamic && result.status != NewtonStatus::converged) {
    result = approach(time_step);
    tried += result.iterations;
    if (result.status != NewtonStatus::converged) {
      result = descend(time_step, kMostDescents);
      tried += result.iterations;
    }
  }
  const auto converged = [&] { return result.status == NewtonStatus::converged; };
  result.iterations = tried;
  take_report(result);
  if (converged() || (!dynamic && is_usable(result))) return;
  if (result.status == NewtonStatus::law_failed) fail_law();
  const std::string folded = describe_folded_cable(*this);
  fail(ErrorKind::not_converged,
       fmt::format("Newton ended as '{}' after {} iterations, relative residual {:.3g}{}",
                   newton_status_name(result.status), result.iterations, result.relative_residual,
                   folded),
       folded.empty() ? "take a smaller time step, or change commands more slowly"
                      : "lessen its tension, or place its points so that they stay apart");
}

// Of the way from where actuators were to what they are told.
void Simulation::blend_commands(std::span<const step::ActuatorBlock> goal,
                                std::span<const ActuatorState> start, double fraction) {
  for (std::size_t i = 0; i < start.size(); ++i) {
    step::ActuatorBlock& block = world_.problem().actuators[i];
    block = goal[i];
    blend(block, start[i], fraction);
  }
}

// What the start of the step lacks to equilibrium is taken away bit by bit, as in statics
// (static_solver.cpp), and commands go in proportion from where the actuators were.
NewtonReport Simulation::approach(double time_step) {
  const std::vector<step::ActuatorBlock> goal = world_.problem().actuators;
  const std::vector<ActuatorState> start = actuators_;
  const NewtonSettings settings = settings_of_part(time_step);
  State sound = state_before_;
  const auto go_back = [&] {
    restore(sound);
    world_.begin_step(now_ - time_step, now_, effort_);
  };
  go_back();
  world_.linearise(settings.request);
  world_.form_rows(effort_, settings.curved);
  world_.hold_imbalance(effort_);
  NewtonReport result;
  int iterations = 0;
  const auto solve = [&](double share) {
    blend_commands(goal, start, 1.0 - share);
    world_.set_imbalance_share(share);
    result = newton(nullptr, settings);
    iterations += result.iterations;
    return result.status == NewtonStatus::converged;
  };
  take_load_steps(
      {.first = 0.5, .least = kLeastPart}, solve, [&] { keep(sound); }, go_back);
  world_.set_imbalance_share(0.0);
  world_.problem().actuators = goal;
  result.iterations = iterations;
  return result;
}

// From where approach() ended: with a matrix that is never less than the derivative every iteration
// lowers the energy of conservative loads, through a buckling to wherever the robot then rests.
// What is slow at the end of that, Newton finishes.
NewtonReport Simulation::descend(double time_step, int iterations) {
  NewtonSettings settings = newton_settings(time_step);
  settings.request.tangent = mechanics::Tangent::projected;
  // A matrix that is never less has the stiffness of all cables, whatever the scene leaves out.
  settings.request.with_curvature = true;
  settings.curved = model_->curved_constraints();
  settings.max_iterations = iterations;
  NewtonReport result = newton(nullptr, settings);
  if (result.status == NewtonStatus::converged || controller_ != nullptr) return result;
  const int descended = result.iterations;
  result = newton(nullptr, settings_of_part(time_step));
  result.iterations += descended;
  return result;
}

// Newton knows. Where it had few iterations, or was not asked, the residual says.
bool Simulation::balanced() const {
  const bool newton = model_->step().method == Method::newton;
  if (newton && report_.newton == NewtonStatus::converged) return true;
  const bool searched = newton && controller_ == nullptr;
  return report_.relative_residual <= (searched ? kSearched : kBalanced);
}

// What users are told of the step.
void Simulation::watch() {
  const auto raise = [&](StepStatus status) { report_.status = std::max(report_.status, status); };
  if (report_.law == LawStatus::limits_conflict) raise(StepStatus::limits_conflict);
  if (report_.scale < 1.0) raise(StepStatus::cut_back);
  if (report_.violation > kReached * model_->size()) raise(StepStatus::command_not_reached);
  if (!balanced()) raise(StepStatus::not_in_equilibrium);
  if (model_->step().dynamic()) watch_energy();
}

// Before the first step that is watched, so that its own gain counts.
void Simulation::open_ledger() {
  if (ledger_.begun != 0.0) return;
  const Energies now = energies();
  ledger_.begun = 1.0;
  ledger_.start = now.strain + now.kinetic + now.gravity - ledger_.put_in();
  ledger_.largest = now.strain + now.kinetic;
}

// Stored energy against what actuators and loads put in since the first step. A base that moves and
// forces from outside the ledger put in what is not counted.
void Simulation::watch_energy() {
  for (const auto& body : world_.bodies()) {
    if (body->moved_from_outside()) {
      ledger_.restart();
      return;
    }
  }
  const Energies now = energies();
  const double stored = now.strain + now.kinetic + now.gravity;
  const double put_in = ledger_.put_in();
  report_.energy_gained = stored - put_in - ledger_.start;
  ledger_.largest = std::max({ledger_.largest, now.strain + now.kinetic, std::abs(put_in)});
  const double nothing = kNoEnergy * world_.force_scale() * model_->size();
  if (report_.energy_gained > kEnergyGain * ledger_.largest + nothing) {
    report_.status = std::max(report_.status, StepStatus::gaining_energy);
  }
}

}  // namespace sinew::sim
