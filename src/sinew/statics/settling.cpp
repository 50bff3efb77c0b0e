#include "sinew/statics/settling.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "sinew/constraint/contact.hpp"
#include "sinew/contact/touching_surfaces.hpp"
#include "sinew/core/error.hpp"
#include "sinew/run/run.hpp"
#include "sinew/statics/free_motion.hpp"
#include "sinew/statics/static_search.hpp"
#include "sinew/statics/step_failure.hpp"
#include "sinew/world/stability.hpp"

namespace sinew::statics {

namespace {

// Tolerance on the gaps of touching points, relative to the robot's size.
constexpr double kSurfaceTolerance = 1e-9;
constexpr int kMaxSurfaceRounds = 60;
// Rounds in succession that did not bring the planes of touching points closer by this factor,
// after which they alternate.
constexpr int kIdleRounds = 4;
constexpr double kCloser = 0.5;

// Maximum number of unstable equilibria that are left in succession, and the disturbances, relative
// to the robot's size, which increase each time.
constexpr int kMaxDepartures = 6;
constexpr double kDisturbance = 1e-2;
constexpr double kLargerDisturbance = 2.0;
// Curvatures that are less negative, relative to the loads over the robot's size, are neutral.
constexpr double kNeutralOfLoads = 1e-6;
// Displacement of a neutral equilibrium, relative to the robot's size, and the multiples of it that
// are left after a return and after a departure.
constexpr double kPush = 2e-3;
// First step of the motion from there, relative to it: it would overshoot a body that rocks.
constexpr double kGentlePush = 0.1;
constexpr double kReturned = 0.5;
constexpr double kLeft = 2.0;
// A motion that has neither ended nor led farther than this multiple does not leave: a rod whose
// round end presses on a wall turns about its axis without end.
constexpr double kLost = 10.0;

}  // namespace

// A free motion at rest is that of a state in which joints and contacts have their forces.
void fail_if_free(StaticSearch& search, const std::string& message) {
  const FreeMotion free(search);
  if (!free.exists()) return;
  fail_free(search.run(), free, message,
            "hold it by a fixed region, a joint, a cable or a contact, remove loose elements of "
            "the mesh, or choose a dynamic integrator");
}

Settling::Settling(StaticSearch& search, OverdampedMotion& motion)
    : run_(search.run()), search_(search), motion_(motion) {}

// A vertex that is pressed onto an edge stands on both of its faces, which take turns: the
// solutions then alternate by less than the overlap that a step leaves to the next one.
void Settling::follow_surfaces() {
  const double tolerance =
      std::max(search_.settings().tolerance, kSurfaceTolerance) * run_.model->size();
  contact::ContactPlanes& planes = run_.world.contacts().planes();
  double overlap = 0.0, least = kInfinity;
  for (const auto& touching : planes.surfaces()) {
    overlap = std::max(overlap, touching->permitted_overlap());
  }
  double off = planes.drift(run_.effort, run_.now);
  int idle = 0;
  for (int round = 0; round < kMaxSurfaceRounds && off > tolerance; ++round) {
    idle = off < kCloser * least ? 0 : idle + 1;
    least = std::min(least, off);
    if (idle >= kIdleRounds && off <= overlap) return;
    if (!search_.equilibrate(0.0) && !motion_.relax_from_here()) break;
    off = planes.drift(run_.effort, run_.now);
  }
  if (off > tolerance || search_.last().status != run::NewtonStatus::converged) {
    fail(run_, ErrorKind::not_converged, "points keep moving along a curved surface",
         "approach the load through time steps");
  }
}

// The tangent at the present state, not at the last iterate. Neutral motions of a loose robot,
// whose stiffness is rounding, get a little inertia, so that they do not count as unstable.
// @return whether it is regular.
bool Settling::condense() {
  if (run_.model->is_loose()) return condense_nearly_at_rest(search_) > 0.0;
  search_.begin();
  search_.linearise();
  return run_.world.condense() != linalg::FactorStatus::singular;
}

// With little inertia, an overdamped motion passes by an unstable equilibrium so slowly that it
// ends there, where the tangent of Newton's method is not definite.
bool Settling::leave_nearby() {
  if (run_.model->is_loose() || !condense()) return false;
  const world::Stability stability(run_.world, run_.effort);
  return stability.negative_pivots() > 0 &&
         motion_.leave(stability, kDisturbance) == OverdampedMotion::End::arrived;
}

// Moves from the present linearised equilibrium to a stable one.
void Settling::settle() {
  double disturbance = kDisturbance;
  StaticReport& report = search_.report();
  const bool has_contacts = !run_.model->contacts().empty();
  if (run_.model->is_loose() && has_contacts) motion_.stand();
  for (int departures = 0;; ++departures) {
    report.stable = true;
    report.negative_pivots = 0;
    if (!condense()) return require_held();
    const bool unsymmetric = run_.world.inertia().unsymmetric;
    const world::Stability stability(run_.world, run_.effort);
    report.negative_pivots = stability.negative_pivots();
    report.stable = report.negative_pivots == 0;
    if (report.stable || search_.settings().stability == StabilityChoice::any) return;
    if (departures == 0 && is_neutral()) {
      report.stable = true;
      report.negative_pivots = 0;
      return require_held();
    }
    const Pushed pushed = touch(stability.mode());
    report.stable = pushed == Pushed::returns || pushed == Pushed::stays;
    if (report.stable) return;
    if (pushed == Pushed::leaves && departures < kMaxDepartures) {
      follow_surfaces();
      continue;
    }
    const auto ended = departures < kMaxDepartures ? motion_.leave(stability, disturbance)
                                                   : OverdampedMotion::End::failed;
    if (ended == OverdampedMotion::End::failed) fail_unstable();
    // With a potential, the motion cannot return by itself: a step was too long. The tangent at
    // points that touch is that of material points, and not of the curved surfaces.
    const bool may_return = unsymmetric || (run_.model->is_loose() && has_contacts);
    if (ended == OverdampedMotion::End::returned && may_return) {
      report.stable = true;
      return;
    }
    if (ended == OverdampedMotion::End::arrived) follow_surfaces();
    disturbance *= kLargerDisturbance;
  }
}

// Whether a robot that joints do not leave free, but whose motor is told an effort that holds
// nothing, is unstable by rounding alone: with the little inertia of a loose robot it is not.
bool Settling::is_neutral() {
  if (run_.model->is_loose() || run_.model->joints().empty()) return false;
  const bool neutral = condense_nearly_at_rest(search_) > 0.0 &&
                       world::Stability(run_.world, run_.effort).negative_pivots() == 0;
  if (!neutral) condense();
  return neutral;
}

void Settling::fail_unstable() {
  const StaticReport& report = search_.report();
  fail(run_, ErrorKind::not_converged,
       fmt::format("the equilibrium is unstable in {} direction{} (negative pivots of the "
                   "exact tangent), and none that is stable was found from it in {} steps "
                   "of overdamped motion",
                   report.negative_pivots, report.negative_pivots == 1 ? "" : "s",
                   report.relaxation_steps),
       "approach the load through time steps, or ask for any equilibrium, stable or not");
}

// What a touch along a motion does to an equilibrium of a loose robot whose tangent says that it
// descends: a tangent that lacks the levers of contacts, and does not know what friction holds.
// Lost: the tangent is right, or the touch does not tell.
Settling::Pushed Settling::touch(const VectorX& motion) {
  const bool doubtful = run_.model->is_loose() && !run_.model->contacts().empty();
  if (!doubtful || motion.size() == 0) return Pushed::lost;
  if (!descends(motion)) return Pushed::stays;
  return sticks() ? push(motion) : Pushed::lost;
}

void Settling::require_held() {
  for (int departures = 0; leave_unheld(); ++departures) {
    if (departures == kMaxDepartures) {
      fail(run_, ErrorKind::not_converged,
           "the bodies roll and slide from one unstable equilibrium to the next",
           "approach the load through time steps, or choose a dynamic integrator");
    }
    follow_surfaces();
    settle();
  }
  search_.begin();  // the tangent at rest, for queries
  search_.linearise();
  run_.world.condense();
}

// Points that slid until the robot came to rest may hold it by less than all of their friction,
// which a solution from rest tells.
// @return whether the equilibrium was unstable, and left for another one.
bool Settling::leave_unheld() {
  if (!run_.model->contacts().empty()) {
    run::State rest;
    run_.keep(rest);
    const run::NewtonReport last = search_.last();
    if (!search_.equilibrate(0.0)) {
      run_.restore(rest);
      search_.put_back(last);
    }
  }
  const FreeMotion free(search_);
  if (!free.exists() || !free.moves_centres()) return false;
  const Pushed pushed = run_.model->contacts().empty() ? Pushed::stays : push(free.motion());
  if (pushed == Pushed::leaves) return true;
  if (pushed == Pushed::returns) return false;
  const auto rests = [&](std::size_t body) { return touches(body); };
  if (!run_.model->is_loose() || !std::ranges::all_of(free.moving(), rests)) {
    fail_free(run_, free, "the equilibrium is neutral",
              "hold it by a fixed region, a joint, a cable, friction or a contact, or choose a "
              "dynamic integrator");
  }
  return false;
}

// Whether a contact presses on a body.
bool Settling::touches(std::size_t body) const {
  const auto index = static_cast<int>(body);
  for (const constraint::Contact* contact : run_.world.contacts().planes().contacts()) {
    if (contact->body() != index && contact->other_body() != index) continue;
    for (std::size_t k = 0; k < contact->size(); ++k) {
      if (run_.effort[static_cast<std::size_t>(contact->row(k))] > 0.0) return true;
    }
  }
  return false;
}

// Whether the curvature along a motion is negative by more than rounding, relative to the loads.
// @param motion with a largest entry of 1.
bool Settling::descends(const VectorX& motion) {
  const double curvature = search_.curvature_along(motion);
  world::Bodies& bodies = run_.world.bodies();
  bodies.residual(run_.effort);
  const double loads = bodies.force_scale() / run_.model->size();
  return curvature < -kNeutralOfLoads * loads;
}

// Whether a contact with friction presses.
bool Settling::sticks() const {
  for (const constraint::Contact* contact : run_.world.contacts().planes().contacts()) {
    if (!(contact->friction().sticking > 0.0)) continue;
    for (std::size_t k = 0; k < contact->size(); ++k) {
      if (run_.effort[static_cast<std::size_t>(contact->row(k))] > 0.0) return true;
    }
  }
  return false;
}

// Displaces an equilibrium along a motion, and lets it go unless the next place is an equilibrium,
// too: Newton's method also returns to an unstable one. The state then is what it was, unless it
// left.
Settling::Pushed Settling::push(const VectorX& motion) {
  run::State rest;
  run_.keep(rest);
  const run::NewtonReport last = search_.last();
  const std::vector<Points> at = motion_.positions();
  world::Bodies& bodies = run_.world.bodies();
  search_.begin();
  bodies.propose_motion(motion);
  bodies.apply_motion(kPush * run_.model->size());
  const double pushed = motion_.moved_since(at);
  run::State displaced;
  run_.keep(displaced);
  bool found = search_.equilibrate(0.0, max_idle(*run_.model));
  const double searched = motion_.moved_since(at);
  if (!found || searched > kLeft * pushed || searched < kReturned * pushed) {
    run_.restore(displaced);
    int& steps = search_.report().relaxation_steps;
    const int before = std::exchange(steps, 0);
    found = motion_.relax_from_here(kGentlePush * kPush);
    steps += before;
  }
  const double moved = motion_.moved_since(at);
  if (moved > kLeft * pushed) {
    if (found) return Pushed::leaves;
    fail_if_free(search_, "there is no equilibrium, since nothing holds a part");
  }
  const bool lost = !found && moved > kLost * pushed;
  run_.restore(rest);
  search_.put_back(last);
  search_.begin();
  if (lost) return Pushed::lost;
  return moved < kReturned * pushed ? Pushed::returns : Pushed::stays;
}

}  // namespace sinew::statics
