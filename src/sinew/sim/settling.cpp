#include "sinew/sim/settling.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/core/error.hpp"
#include "sinew/sim/free_motion.hpp"
#include "sinew/sim/run.hpp"
#include "sinew/sim/stability.hpp"
#include "sinew/sim/static_search.hpp"
#include "sinew/sim/step_failure.hpp"

namespace sinew::sim {

namespace {

// Tolerance on the gaps of touching points, relative to the robot's size.
constexpr double kSurfaceTolerance = 1e-9;
constexpr int kMaxSurfaceRounds = 60;

// Maximum number of unstable equilibria that are left in succession, and the disturbances, relative
// to the robot's size, which increase each time.
constexpr int kMaxDepartures = 6;
constexpr double kDisturbance = 1e-2;
constexpr double kLargerDisturbance = 2.0;
// Displacement of a neutral equilibrium, relative to the robot's size, and the part of it that may
// be left if it is stable.
constexpr double kPush = 2e-3;
constexpr double kReturned = 0.5;

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

void Settling::follow_surfaces() {
  const double tolerance =
      std::max(search_.settings().tolerance, kSurfaceTolerance) * run_.model->size();
  ContactPlanes& planes = run_.world.contacts().planes();
  const auto off = [&] { return planes.drift(run_.effort, run_.now) > tolerance; };
  for (int round = 0; round < kMaxSurfaceRounds; ++round) {
    if (!off()) return;
    if (!search_.equilibrate(0.0) && !motion_.relax_from_here()) break;
  }
  if (off() || search_.last().status != NewtonStatus::converged) {
    fail(run_, ErrorKind::not_converged, "points keep moving along a curved surface",
         "approach the load through time steps");
  }
}

// Moves from the present linearised equilibrium to a stable one.
void Settling::settle() {
  double disturbance = kDisturbance;
  StaticReport& report = search_.report();
  State rest;  // before the first departure
  NewtonReport last;
  for (int departures = 0;; ++departures) {
    // Needs the tangent at this state, not at the last iterate.
    search_.begin();
    search_.linearise();
    report.stable = true;
    report.negative_pivots = 0;
    if (run_.world.condense() == linalg::FactorStatus::singular) return require_held();
    const bool unsymmetric = run_.world.inertia().unsymmetric;
    const Stability stability(run_.world, run_.effort);
    report.negative_pivots = stability.negative_pivots();
    report.stable = report.negative_pivots == 0;
    if (report.stable || search_.settings().stability == StabilityChoice::any) return;
    if (departures == 0) {
      run_.keep(rest);
      last = search_.last();
    }
    const auto ended = departures < kMaxDepartures ? motion_.leave(stability, disturbance)
                                                   : OverdampedMotion::End::failed;
    if (ended == OverdampedMotion::End::failed) {
      if (run_.model->is_loose()) {  // neutral motions may count as unstable
        run_.restore(rest);
        search_.put_back(last);
        require_held();
      }
      fail(run_, ErrorKind::not_converged,
           fmt::format("the equilibrium is unstable in {} direction{} (negative pivots of the "
                       "exact tangent), and none that is stable was found from it in {} steps "
                       "of overdamped motion",
                       report.negative_pivots, report.negative_pivots == 1 ? "" : "s",
                       report.relaxation_steps),
           "approach the load through time steps, or ask for any equilibrium, stable or not");
    }
    // With a potential, the motion cannot return by itself: a step was too long.
    if (ended == OverdampedMotion::End::returned && unsymmetric) {
      report.stable = true;
      return;
    }
    if (ended == OverdampedMotion::End::arrived) follow_surfaces();
    disturbance *= kLargerDisturbance;
  }
}

// Points that slid until the robot came to rest may hold it by less than all of their friction,
// which a solution from rest tells.
void Settling::require_held() {
  if (!run_.model->contacts().empty()) {
    State rest;
    run_.keep(rest);
    const NewtonReport last = search_.last();
    if (!search_.equilibrate(0.0)) {
      run_.restore(rest);
      search_.put_back(last);
    }
  }
  const FreeMotion free(search_);
  if (free.exists() && free.moves_centres() && !returns(free.motion())) {
    fail_free(run_, free, "the equilibrium is neutral",
              "hold it by a fixed region, a joint, a cable, friction or a contact, or choose a "
              "dynamic integrator");
  }
  search_.begin();  // the tangent at rest, for queries
  search_.linearise();
  run_.world.condense();
}

// The tangent does not contain the curvature of surfaces that touch: a ball at the bottom of a bowl
// has none. Displaced along its motion, it rolls back.
bool Settling::returns(const VectorX& motion) {
  if (run_.model->contacts().empty()) return false;
  State rest;
  run_.keep(rest);
  const NewtonReport last = search_.last();
  const std::vector<Points> at = motion_.positions();
  Bodies& bodies = run_.world.bodies();
  search_.begin();
  bodies.propose_motion(motion);
  bodies.apply_motion(kPush * run_.model->size());
  const double pushed = motion_.moved_since(at);
  motion_.relax_from_here();
  const bool back = motion_.moved_since(at) < kReturned * pushed;
  run_.restore(rest);
  search_.put_back(last);
  search_.begin();
  return back;
}

}  // namespace sinew::sim
