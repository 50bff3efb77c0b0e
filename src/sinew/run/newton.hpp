/// @file
/// Newton's method for the equation of a step together with its laws. Each iteration linearises,
/// condenses, solves the laws and moves the bodies, with a line search.
#pragma once

#include <limits>
#include <span>

#include "sinew/law/law_status.hpp"
#include "sinew/mechanics/step_system.hpp"
#include "sinew/run/newton_status.hpp"
#include "sinew/run/step_tolerances.hpp"
#include "sinew/world/sanity.hpp"

namespace sinew::law {
class Controller;
class StepSolver;
}  // namespace sinew::law

namespace sinew::world {
class StageClock;
class World;
}  // namespace sinew::world

namespace sinew::run {

class KeptFactors;
class StepWatch;

struct NewtonSettings {
  mechanics::LinearisationRequest request;
  double tolerance = 1e-8;         ///< on the residual relative to the loads
  double motion_tolerance = 1e-8;  ///< on the law's violation relative to the robot's size
  int max_iterations = 50;
  std::span<const int> geometric = {};  ///< constraints whose geometric stiffness is added to A
  Lag lag = {};
  /// Both tolerances where iterations no longer reduce the residual; 0: the same as above.
  double stalled_tolerance = 0.0;
  /// Whether a solution found with another matrix than the derivative must have a small residual,
  /// since a matrix larger than the derivative gives small motions even far from an equilibrium.
  bool strict = false;
  /// Whether later iterations may keep the factor of an earlier one, and how well that served in
  /// earlier searches; null: they may not. Updated at the end.
  KeptFactors* kept_factors = nullptr;
  /// With a controller: once the error of an iteration with its choice is within these bounds, the
  /// efforts that it chose are held in all later iterations; 0: it chooses in every iteration.
  Lag choice = {};
  /// The search ends after this many iterations in which a controller chose; 0: no limit.
  int max_choices = 0;
  /// The search ends after this many iterations if each of them found the exact tangent indefinite;
  /// 0: no limit.
  int max_indefinite = 0;
  /// The search ends after this many iterations in succession none of which lowered the residual,
  /// or the violation, below the lowest so far; 0: no limit.
  int max_idle = 0;
};

struct NewtonReport {
  NewtonStatus status = NewtonStatus::converged;
  int iterations = 0;
  double residual = 0.0;           ///< N, |p - f - ... + H^T lambda|
  double relative_residual = 0.0;  ///< relative to the sum of the forces' norms
  double violation = 0.0;          ///< m, of the law
  /// m, bound of the distance to the solution if it follows from the moves of the iterations (see
  /// distance_bound()); else NaN.
  double distance = std::numeric_limits<double>::quiet_NaN();
  int factorisations = 0;
  int tangent_fallbacks = 0;  ///< iterations in which the exact tangent was indefinite
  double first_move = 0.0;    ///< m, largest change of a coordinate in a full first iteration
  double whole_move = 0.0;    ///< m, the sum of those of all iterations
  law::LawStatus law = law::LawStatus::solved;
  mechanics::MotionReport motion;
  world::Sanity sanity;  ///< of the state at the end
};

/// Runs Newton's method from the world's present state. On return, the bodies are linearised at the
/// last state.
/// @param world is moved; the actuators of its problem contain their commands.
/// @param solver of the step's laws.
/// @param controller chooses the efforts of its actuators; null if there is none.
/// @param effort (rows,) N, in and out. @param settings tolerances and limits.
/// @param clock records the times of the stages.
/// @param watch is notified of every iteration, and may throw.
NewtonReport solve_newton(world::World& world, law::StepSolver& solver, law::Controller* controller,
                          std::span<double> effort, const NewtonSettings& settings,
                          world::StageClock& clock, StepWatch& watch);

}  // namespace sinew::run
