/// @file
/// Efforts of a step, chosen by a controller where there is one.
#pragma once

#include <span>
#include <vector>

#include "sinew/step/controller.hpp"
#include "sinew/step/direct_solver.hpp"
#include "sinew/step/law_status.hpp"
#include "sinew/step/response.hpp"

namespace sinew::step {

/// Without a controller, the direct solver. With one, in rounds: the controller chooses its efforts
/// for the robot as it answers while every other block keeps its state (Response); the direct
/// solver then finds what the others really do at these efforts; and where a contact opened, a
/// cable began to slide or a drive's curve bent, the controller chooses again.
///
/// Where rounds do not settle, or end at efforts that serve less well than the last step's, the
/// optimum lies where blocks are about to change their states: a point that just touches, a cable
/// about to slide. It is looked for by descent over pieces, in each of which all blocks keep their
/// states (a mathematical program with complementarity constraints, in the way of implicit
/// programming: Luo, Pang & Ralph, Mathematical Programs with Equilibrium Constraints, 1996, ch. 2
/// and 6). From the last step's efforts on, the controller chooses within the piece, held by its
/// guards. At the optimum of the piece multipliers of guards tell across which of them the
/// objective falls: that block takes the state beyond, the largest multiplier first, then all of
/// them together; and so on until no neighbour serves better. What is kept is judged by the direct
/// solver at the efforts chosen, so that every place on the way obeys all laws, and the objective
/// falls from one to the next: there are no cycles. Where a piece bends (slip that turns, a drive's
/// curve) its tangent is followed as far as the objective falls.
///
/// The place that is left is stationary: no single block that changes its state, nor all that push
/// together, leads on. Where an actuator holds the very motion of a controlled one (a commanded
/// cable on the same line), the controller may take over its load: that is tried as well, and kept
/// where it serves better. Every block but the controller's objective is obeyed exactly, whatever
/// was chosen.
class StepSolver {
 public:
  explicit StepSolver(const qp::ConeSettings& settings = {})
      : cone_settings_(settings), direct_(settings) {}

  void begin_step() { direct_.begin_step(); }
  /// @param problem of the step. @param controller of the owned actuators; null where there are
  ///   none. @param effort (rows,) N: where to start from; on return the solution.
  LawStatus solve(const StepProblem& problem, Controller* controller, std::span<double> effort);
  const DirectSolver& direct() const { return direct_; }

 private:
  LawStatus steer(const StepProblem& problem, Controller& controller, std::span<double> effort);
  /// The controller's choice, put into `effort`; the largest change that this makes, relative.
  LawStatus choose(const StepProblem& problem, Controller& controller, std::span<double> effort,
                   double& change);
  using Merit = Controller::Merit;
  /// Efforts of the controlled actuators, all others by the direct solver; what comes of it is
  /// in motion_.
  Merit try_efforts(const StepProblem& problem, const Controller& controller,
                    std::span<const double> own, std::span<double> effort);
  static bool is_better(const Controller& controller, const Merit& one, const Merit& other);
  LawStatus descend(const StepProblem& problem, Controller& controller, std::span<double> effort);
  bool advance(const StepProblem& problem, Controller& controller, const Response& response,
               std::span<double> effort);
  bool cross_guards(const StepProblem& problem, Controller& controller, std::span<double> effort);
  void keep_place(const Merit& merit, std::span<const double> effort);
  /// Rounds until states and efforts agree.
  LawStatus settle(const StepProblem& problem, Controller& controller, std::span<double> effort);
  /// Tries to take the place of what holds the motion of a controlled actuator.
  LawStatus take_over(const StepProblem& problem, Controller& controller, std::span<double> effort);
  void measure_motion(const StepProblem& problem, std::span<const double> effort);

  qp::ConeSettings cone_settings_;
  DirectSolver direct_;
  Response response_, beyond_;
  std::vector<double> chosen_;          // (controlled,) N
  std::vector<double> trial_, middle_;  // (controlled,) N
  std::vector<double> place_;           // (rows,) N: the best so far
  Merit merit_;                         // there
  struct Push {
    double multiplier;
    int guard;
  };
  std::vector<Push> pushing_;       // guards that hold the choice
  std::vector<BlockState> states_;  // (blocks,)
  std::vector<double> held_;        // (controlled,) N, without taking over
  VectorX motion_;                  // (rows,) m
};

}  // namespace sinew::step
