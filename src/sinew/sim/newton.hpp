/// @file
/// Newton's method on a step's equation and its law together: every iteration linearises,
/// condenses, solves the law and moves, with a line search.
#pragma once

#include <span>

#include "sinew/mechanics/step_system.hpp"
#include "sinew/sim/newton_status.hpp"
#include "sinew/step/law_status.hpp"

namespace sinew::step {
class Controller;
class StepSolver;
}  // namespace sinew::step

namespace sinew::sim {

class StageClock;
class StepWatch;
class World;

/// What an iteration may leave for the next step although the residual is above its tolerance. A
/// full iteration with the derivative leaves a move of second order in its own: about this one
/// times the relative residual.
struct Lag {
  double residual = 0.0;  ///< relative; 0: nothing is left
  double move = 0.0;      ///< largest move times relative residual, of the robot's size
};

struct NewtonSettings {
  mechanics::LinearisationRequest request;
  double tolerance = 1e-8;         ///< on the residual relative to the loads
  double motion_tolerance = 1e-8;  ///< on the law's violation relative to the robot's size
  int max_iterations = 50;
  std::span<const int> geometric = {};  ///< constraints whose geometric stiffness joins A
  Lag lag = {};
  /// As many first iterations of which each found the exact tangent indefinite are the last; 0: any
  /// number.
  int max_indefinite = 0;
};

struct NewtonReport {
  NewtonStatus status = NewtonStatus::converged;
  int iterations = 0;
  double residual = 0.0;           ///< N, |p - f - ... + H^T lambda|
  double relative_residual = 0.0;  ///< of the sum of the forces' norms
  double violation = 0.0;          ///< m, of the law
  int factorisations = 0;
  int tangent_fallbacks = 0;  ///< iterations in which the exact tangent was indefinite
  step::LawStatus law = step::LawStatus::solved;
  mechanics::MotionReport motion;
};

/// Iterates from the world's current state. On return the bodies are linearised at the last state.
/// @param world is moved; its problem's actuators are told what to do. @param solver finds efforts.
/// @param controller chooses those of owned actuators; null where there are none.
/// @param effort (rows,) N, in and out. @param settings see there. @param clock gets the stages'
/// times. @param watch is told of every iteration, and may throw.
NewtonReport solve_newton(World& world, step::StepSolver& solver, step::Controller* controller,
                          std::span<double> effort, const NewtonSettings& settings,
                          StageClock& clock, StepWatch& watch);

}  // namespace sinew::sim
