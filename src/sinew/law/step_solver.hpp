/// @file
/// Solution of a step, with or without a controller.
#pragma once

#include <span>
#include <vector>

#include "sinew/law/controller.hpp"
#include "sinew/law/direct_solver.hpp"
#include "sinew/law/law_status.hpp"
#include "sinew/law/response.hpp"

namespace sinew::law {

/// Solver of a step. Without a controller it is the direct solver. With one, it proceeds in rounds.
/// The controller chooses its efforts for the response of the robot while every other block keeps
/// its state (Response). The direct solver then finds the actual response of the other blocks to
/// these efforts. If a contact opened, a cable began to slide or a drive's curve changed its slope,
/// the controller chooses again.
///
/// If rounds do not converge, or end at efforts with less merit than those of the last step, the
/// optimum lies where blocks are about to change state, such as a point that just touches or a
/// cable about to slide. It is found by descent over pieces, in each of which all blocks keep their
/// states (a mathematical program with complementarity constraints, solved by implicit programming:
/// Luo, Pang & Ralph, Mathematical Programs with Equilibrium Constraints, 1996, ch. 2 and 6).
/// Starting from the last step's efforts, the controller chooses within the piece, constrained by
/// its guards. At the optimum of the piece, the multipliers of the guards tell across which of them
/// the objective decreases. Their blocks take the states beyond: first the one with the largest
/// multiplier, then each of the others, then all together; this repeats until no adjacent piece has
/// more merit. Every point kept is evaluated by the direct solver at the chosen efforts, so that it
/// obeys all laws and the objective decreases from one to the next: there are no cycles. If a piece
/// is curved (slip that turns, a drive's curve), its tangent is followed as far as the objective
/// decreases.
///
/// The result is stationary: no change of state of a single block, nor of all that push together,
/// improves it. If an actuator holds the motion of a controlled one (a commanded cable on the same
/// line), the controller may take over its load; this is tried as well, and kept if it has more
/// merit. Every block obeys its law exactly, whatever the controller chooses.
class StepSolver {
 public:
  explicit StepSolver(const qp::ConeSettings& settings = {})
      : cone_settings_(settings), direct_(settings) {}

  void begin_step() { direct_.begin_step(); }
  /// Solves a step. @param problem of the step.
  /// @param controller of the owned actuators; null if there are none.
  /// @param effort (rows,) N: initial guess; on return the solution.
  LawStatus solve(const StepProblem& problem, Controller* controller, std::span<double> effort);
  const DirectSolver& direct() const { return direct_; }

 private:
  LawStatus steer(const StepProblem& problem, Controller& controller, std::span<double> effort);
  /// Writes the controller's choice into `effort`; `change` is the largest relative change of an
  /// effort.
  LawStatus choose(const StepProblem& problem, Controller& controller, std::span<double> effort,
                   double& change);
  using Merit = Controller::Merit;
  /// Evaluates efforts of the controlled actuators, with all others by the direct solver; writes
  /// motion_.
  Merit try_efforts(const StepProblem& problem, const Controller& controller,
                    std::span<const double> own, std::span<double> effort);
  static bool is_better(const Controller& controller, const Merit& one, const Merit& other);
  LawStatus descend(const StepProblem& problem, Controller& controller, std::span<double> effort);
  bool advance(const StepProblem& problem, Controller& controller, const Response& response,
               std::span<double> effort);
  bool cross_guards(const StepProblem& problem, Controller& controller, std::span<double> effort);
  void keep_place(const Merit& merit, std::span<const double> effort);
  /// Iterates until states and efforts agree.
  LawStatus settle(const StepProblem& problem, Controller& controller, std::span<double> effort);
  /// Tries to take over the load of an actuator that holds the motion of a controlled one.
  LawStatus take_over(const StepProblem& problem, Controller& controller, std::span<double> effort);
  void measure_motion(const StepProblem& problem, std::span<const double> effort);

  qp::ConeSettings cone_settings_;
  DirectSolver direct_;
  Response response_, beyond_;
  std::vector<double> chosen_;          // (controlled,) N
  std::vector<double> trial_, middle_;  // (controlled,) N
  std::vector<double> place_;           // (rows,) N: the best efforts so far
  Merit merit_;                         // merit of place_
  struct Push {
    double multiplier;
    int guard;
  };
  std::vector<Push> pushing_;       // guards that constrain the choice
  std::vector<BlockState> states_;  // (blocks,)
  std::vector<double> held_;        // (controlled,) N, without taking over
  VectorX motion_;                  // (rows,) m
};

}  // namespace sinew::law
