#include "sinew/run/newton.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sinew/run/actuation.hpp"
#include "sinew/run/kept_factors.hpp"
#include "sinew/run/step_watch.hpp"
#include "sinew/world/stage_clock.hpp"
#include "sinew/world/world.hpp"

namespace sinew::run {

namespace {

// Factor by which a step may raise the merit. A slender body that an iteration rotates by t is
// stretched by t^2/2, which causes a force of about 6 t (L/h)^2 times the bending force: 50 at 0.1
// rad and L/h = 9. Of 400 random robots (validation/cases/default_steps.py), the number with
// flagged steps is 49 for a factor of 1, 24 for 2, 3 for 10, and none for 50 and more, at 155, 102,
// 81, 76 and 73 thousand iterations.
constexpr double kMeritGrowth = 50.0;
constexpr int kMaxHalvings = 12;
// Motions below this fraction of a robot's size are rounding. Residuals below the second fraction
// of its forces may then be rounding, too, if the laws are solved iteratively.
constexpr double kRounding = 1e-11;
constexpr double kRoundedResidual = 1e-7;
// Further iterations for a tolerance that is asked for, once motions are rounding: a matrix larger
// than the derivative may lower the residual slowly.
constexpr int kAfterRest = 25;
// An iteration that leaves more than this fraction of the residual no longer converges.
constexpr double kLessened = 0.5;
// Iterations without such a reduction after which the residual has stalled.
constexpr int kIdle = 4;
// A factor is kept while motions shrink to this fraction from one iteration to the next. It is not
// tried again in a step after this many refusals.
constexpr double kContraction = 0.25;
// Largest part of the residual that two motions with a kept factor may leave.
constexpr double kRemoved = 0.1;
constexpr int kMostRefused = 2;
// Smaller first motions, relative to the robot's size, are expected to leave no residual.
constexpr double kTiny = 1e-6;
// An iteration makes progress if it lowers the merit below this fraction of the lowest so far.
constexpr double kProgress = 0.9;

class NewtonSolver {
 public:
  NewtonSolver(world::World& world, law::StepSolver& solver, law::Controller* controller,
               std::span<double> effort, const NewtonSettings& settings, world::StageClock& clock,
               StepWatch& watch)
      : world_(world),
        solver_(solver),
        controller_(controller),
        effort_(effort),
        settings_(settings),
        clock_(clock),
        watch_(watch) {}

  NewtonReport run() {
    linearise(settings_.request.tangent, true);
    while (report_.iterations < settings_.max_iterations + (rested_ ? kAfterRest : 0)) {
      if (converged_) return finish(NewtonStatus::converged);
      const NewtonStatus proposed = propose();
      if (proposed != NewtonStatus::converged) return finish(proposed);
      const NewtonStatus moved = move();
      ++report_.iterations;
      report_.whole_move += report_.motion.largest_move;
      watch_.count(report_.relative_residual);
      if (moved != NewtonStatus::converged) return finish(moved);
      if (is_only_descending() || is_idle() || has_chosen_too_often()) break;
      const bool chosen = may_hold_choice() && report_.law == law::LawStatus::solved;
      if (chosen && !converged_ && lags_little(settings_.choice)) hold_choice();
    }
    const bool done =
        converged_ || (rested_ && is_rounded()) || (idle_ > 0 && is_within_stalled_tolerance());
    return finish(done ? NewtonStatus::converged : NewtonStatus::iteration_limit);
  }

 private:
  bool has_chosen_too_often() const {
    return controller_ != nullptr && settings_.max_choices > 0 &&
           report_.iterations >= settings_.max_choices;
  }

  bool may_hold_choice() const { return controller_ != nullptr && settings_.choice.residual > 0.0; }

  // A controller aims at its target along one linearisation; the next step corrects what the robot
  // makes of it. Choosing again in later iterations of this step would need W of each of their
  // states, hence new factors.
  void hold_choice() {
    command_efforts(world_.problem().actuators, effort_);
    controller_ = nullptr;
  }

  bool is_idle() {
    const double left = report_.relative_residual + report_.violation / world_.problem().size;
    lost_ = left < kProgress * lowest_ ? 0 : lost_ + 1;
    lowest_ = std::min(lowest_, left);
    return settings_.max_idle > 0 && lost_ >= settings_.max_idle;
  }

  bool is_only_descending() const {
    return settings_.max_indefinite > 0 && report_.iterations >= settings_.max_indefinite &&
           report_.tangent_fallbacks == report_.iterations;
  }

  void linearise(mechanics::Tangent tangent, bool with_matrix) {
    auto request = settings_.request;
    request.tangent = tangent;
    request.with_matrix = with_matrix;
    world_.linearise(request);
    has_matrix_ = with_matrix;
    clock_.mark(world::Stage::assembly);
    world_.form_rows(effort_, settings_.geometric);
    clock_.mark(world::Stage::rows);
  }

  // Whether the next iteration may use the factor of the last condensation. A controller that
  // chooses needs W of the present state. New factors need fewer iterations: near their limit, none
  // is kept.
  bool may_keep_factor() const {
    return settings_.kept_factors != nullptr && (controller_ == nullptr || may_hold_choice()) &&
           derivative_ && refused_ < kMostRefused &&
           4 * report_.iterations < settings_.max_iterations;
  }

  bool pays() const {
    return settings_.kept_factors->pays(report_.relative_residual, settings_.tolerance);
  }

  // Proposes a motion that obeys the laws.
  NewtonStatus propose() {
    before_ = moved_;
    const bool may_keep = full_step_ && controller_ == nullptr && may_keep_factor();
    if (report_.iterations > 0 && may_keep && pays() && propose_again()) {
      return NewtonStatus::converged;
    }
    kept_ = false;
    if (!has_matrix_) linearise(settings_.request.tangent, true);
    if (!condense(controller_ == nullptr)) return NewtonStatus::singular;
    report_.law = world_.solve_step(solver_, controller_, effort_, clock_);
    if (braced_ && report_.law == law::LawStatus::failed) {  // something taut would become slack
      std::ranges::copy(world_.efforts_before(), effort_.begin());
      linearise(settings_.request.tangent, true);
      if (!condense(false)) return NewtonStatus::singular;
      report_.law = world_.solve_step(solver_, controller_, effort_, clock_);
    }
    return report_.law == law::LawStatus::failed ? NewtonStatus::law_failed
                                                 : NewtonStatus::converged;
  }

  // The same with the last factor, which is used where the material has turned since (see
  // fem::NodeTurns). The error of these rotations makes axial forces of a slender robot bend it,
  // and bending stretch it: motions shrink by q in every second iteration. A motion is refused if
  // more than about four would have to follow, since a new factor costs less than these.
  bool propose_again() {
    const law::LawStatus law = world_.solve_step_again(solver_, effort_, clock_);
    const double most =
        std::min(kContraction, std::sqrt(settings_.tolerance / report_.relative_residual));
    const bool shrinks = world_.bodies().proposed_move() <= most * report_.motion.largest_move;
    const bool contracts = law != law::LawStatus::failed && (shrinks || removes());
    if (contracts) {
      report_.law = law;
      kept_ = true;
      return true;
    }
    std::ranges::copy(world_.efforts_before(), effort_.begin());
    left_ = 1.0;
    ++refused_;
    return false;
  }

  // Whether the last two motions, one of them with a kept factor, have removed most of the
  // residual.
  bool removes() const { return kept_ && report_.residual <= kRemoved * residual_before_last_; }

  // The exact tangent may be indefinite far from equilibrium; the projected one is not. If the
  // tangent has an unsymmetric part (pressure on an open surface that has curled up), its symmetric
  // part may be indefinite at stable equilibria, which no other tangent can find.
  //
  // @param may_brace whether what is taut may be supposed to stay so.
  bool condense(bool may_brace) {
    auto status = world_.condense();
    ++report_.factorisations;
    bool stable = world_.is_stable() ||
                  (status == linalg::FactorStatus::indefinite && world_.inertia().unsymmetric);
    braced_ = !stable && may_brace && settings_.request.tangent == mechanics::Tangent::exact &&
              world_.brace(effort_);
    stable = stable || braced_;
    derivative_ =
        stable && settings_.request.tangent == mechanics::Tangent::exact && !world_.has_majorant();
    if (!stable && settings_.request.tangent == mechanics::Tangent::exact) {
      clock_.mark(world::Stage::factorisation);
      linearise(mechanics::Tangent::projected, true);
      status = world_.condense();
      ++report_.factorisations;
      ++report_.tangent_fallbacks;
    }
    clock_.mark(world::Stage::factorisation);
    return status != linalg::FactorStatus::singular;
  }

  // Both terms decrease in proportion to (1 - step length) along the Newton direction.
  void measure_residual() {
    report_.residual = world_.bodies().residual(effort_);
    const double scale = world_.bodies().force_scale() + 1e-300;
    report_.relative_residual = report_.residual / scale;
  }

  double merit() {
    measure_residual();
    report_.violation = world_.violation(effort_, report_.law);
    return report_.relative_residual + report_.violation / world_.problem().size;
  }

  // A residual says little about the distance to the solution: a small linearised rotation
  // stretches a slender robot and causes large axial forces, but the motion that removes them is of
  // second order in the rotation.
  bool lags_little(const Lag& lag) const {
    const double left = report_.motion.largest_move * report_.relative_residual;
    return full_step_ && derivative_ && report_.relative_residual <= lag.residual &&
           left <= lag.move * world_.problem().size;
  }

  // Whether the last full step did not reduce the residual, or moved nothing beyond rounding.
  bool is_spent() const {
    return stagnant_ ||
           (full_step_ && report_.motion.largest_move <= kEpsilon * world_.problem().size);
  }

  bool obeys_laws() const {
    const double most = std::max(settings_.motion_tolerance, kRounding);
    return report_.violation <= most * world_.problem().size;
  }

  // The residual is small enough to be that of rounding of positions.
  bool is_rounded() const { return report_.relative_residual <= kRoundedResidual && obeys_laws(); }

  // If rounding keeps the residual above the tolerance, the solution is final when a full step
  // moves nothing beyond rounding, or no longer reduces a residual at its rounding floor. A
  // tolerance that is asked for holds as long as the iterations that remain lower the residual.
  bool converged() {
    if (!obeys_laws()) return false;
    const bool at_rest = full_step_ && is_rounded() &&
                         report_.motion.largest_move <= kRounding * world_.problem().size;
    rested_ = rested_ || at_rest;
    const bool final = settings_.strict || !(report_.residual < residual_before_);
    const double tolerance = settings_.strict && !derivative_
                                 ? std::min(settings_.tolerance, kRoundedResidual)
                                 : settings_.tolerance;
    // The floor is last, since it takes the sums of the matrix.
    return report_.relative_residual <= tolerance || (at_rest && final) ||
           lags_little(settings_.lag) || (is_spent() && report_.residual <= rounding_floor());
  }

  // It takes the sums of the matrix, which hardly changes within a step.
  double rounding_floor() {
    if (!floor_) floor_ = world_.bodies().rounding_floor();
    return *floor_;
  }

  NewtonStatus move() {
    const double before = merit();
    const double residual_before = report_.residual;
    residual_before_last_ = std::exchange(residual_before_, residual_before);
    bool inverted = false;
    double scale = 1.0;
    for (int halving = 0; halving <= kMaxHalvings; ++halving, scale *= 0.5) {
      report_.motion = world_.bodies().apply_motion(scale);
      clock_.mark(world::Stage::correction);
      inverted = true;
      if (!report_.motion.finite) continue;
      linearise(settings_.request.tangent, needs_matrix(halving == 0));
      report_.motion.volume = world_.bodies().smallest_volume();
      inverted = !(report_.motion.volume.ratio > 0.0);
      if (inverted) continue;
      const double after = merit();
      if (report_.iterations == 0) report_.first_move = report_.motion.largest_move / scale;
      full_step_ = halving == 0;
      stagnant_ = full_step_ && report_.residual > kLessened * residual_before;
      moved_ = full_step_ ? report_.motion.largest_move : 0.0;
      if (kept_) measure_kept(residual_before);
      if (report_.iterations == 0) next_ = report_.relative_residual;
      converged_ = converged();
      if (!converged_ && !(after < kMeritGrowth * before)) continue;
      converged_ = converged_ || has_stalled();
      return NewtonStatus::converged;
    }
    return inverted ? NewtonStatus::inverted : NewtonStatus::stalled;
  }

  // The mean over the motions with a kept factor: they may shrink in every second one only.
  void measure_kept(double residual_before) {
    if (kept_count_++ == 0) kept_from_ = residual_before;
    left_ = full_step_ ? std::pow(report_.residual / kept_from_, 1.0 / kept_count_) : 1.0;
  }

  // Whether the next iteration, or the next step, is expected to need the matrix at the state that
  // is about to be linearised. A wrong guess costs time only.
  bool needs_matrix(bool full_step) const {
    if (!full_step || !may_keep_factor()) return true;
    if (report_.iterations == 0 && !settings_.kept_factors->will_pay(settings_.tolerance)) {
      return true;
    }
    // The residual before the first motion says nothing of what commands and choices have changed.
    const bool first = report_.iterations == 0;
    const double shrinks = kept_ && before_ > 0.0 ? report_.motion.largest_move / before_ : 1.0;
    const bool small = report_.motion.largest_move <= kTiny * world_.problem().size;
    const bool ends = settings_.lag.residual > 0.0 ||
                      (first ? small : shrinks * report_.relative_residual <= settings_.tolerance);
    return ends && world_.bodies().keep_linearisation();
  }

  bool is_within_stalled_tolerance() const {
    const double most = settings_.stalled_tolerance;
    return report_.relative_residual <= most && report_.violation <= most * world_.problem().size;
  }

  // Whether iterations with new matrices have ceased to reduce the residual, within the tolerance
  // for this case.
  bool has_stalled() {
    if (report_.relative_residual <= kLessened * best_) {
      best_ = report_.relative_residual;
      idle_ = 0;
    } else if (!kept_) {
      ++idle_;
    } else if (!removes()) {
      refused_ = kMostRefused;
    }
    return idle_ >= kIdle && !kept_ && is_within_stalled_tolerance();
  }

  // Without an iteration, the report is that of the state at the start.
  NewtonReport finish(NewtonStatus status) {
    // A singular matrix gives no compliance by which the laws could be measured.
    if (report_.iterations == 0 && status == NewtonStatus::singular) measure_residual();
    if (report_.iterations == 0 && status != NewtonStatus::singular) merit();
    if (settings_.kept_factors != nullptr) settings_.kept_factors->take(left_, next_);
    report_.sanity = world::examine(world_, effort_);
    report_.motion.volume = report_.sanity.volume;
    const bool lost = status == NewtonStatus::converged && !report_.sanity.sound();
    report_.status = lost ? NewtonStatus::unphysical : status;
    // With a kept factor, a motion may be followed by one as large, before the others shrink by
    // kContraction or more.
    if (status == NewtonStatus::converged && kept_ && moved_ > 0.0) report_.distance = 2.0 * moved_;
    return report_;
  }

  world::World& world_;
  law::StepSolver& solver_;
  law::Controller* controller_;
  std::span<double> effort_;
  const NewtonSettings& settings_;
  world::StageClock& clock_;
  StepWatch& watch_;
  NewtonReport report_;
  bool converged_ = false;             // after the last motion
  bool full_step_ = false;             // whether that motion was a full step
  bool rested_ = false;                // whether a motion was rounding
  bool derivative_ = false;            // whether the condensed matrix was the derivative
  bool braced_ = false;                // whether it is stable only if what is taut stays so
  bool stagnant_ = false;              // the last full step did not lessen the residual
  bool has_matrix_ = false;            // whether the last linearisation included the matrix
  bool kept_ = false;                  // whether the last motion used an earlier factor
  int refused_ = 0;                    // motions with an earlier factor that were refused
  double left_ = 0.0, next_ = 0.0;     // see KeptFactors::take()
  double kept_from_ = 0.0;             // N, residual before the first motion with a kept factor
  int kept_count_ = 0;                 // such motions
  double moved_ = 0.0, before_ = 0.0;  // m, the last full moves; 0: not a full step
  double residual_before_ = 0.0, residual_before_last_ = 0.0;  // N, before the last two motions
  std::optional<double> floor_;                                // N, see rounding_floor()
  double best_ = INFINITY;                                     // relative residual
  int idle_ = 0;                                               // iterations since
  double lowest_ = kInfinity;                                  // merit
  int lost_ = 0;                                               // iterations since without progress
};

}  // namespace

std::string_view newton_status_name(NewtonStatus status) {
  switch (status) {
    case NewtonStatus::converged:
      return "converged";
    case NewtonStatus::iteration_limit:
      return "iteration-limit";
    case NewtonStatus::stalled:
      return "stalled";
    case NewtonStatus::inverted:
      return "inverted";
    case NewtonStatus::singular:
      return "singular";
    case NewtonStatus::law_failed:
      return "law-failed";
    case NewtonStatus::unphysical:
      return "unphysical";
  }
  return "unknown";
}

NewtonReport solve_newton(world::World& world, law::StepSolver& solver, law::Controller* controller,
                          std::span<double> effort, const NewtonSettings& settings,
                          world::StageClock& clock, StepWatch& watch) {
  return NewtonSolver(world, solver, controller, effort, settings, clock, watch).run();
}

}  // namespace sinew::run
