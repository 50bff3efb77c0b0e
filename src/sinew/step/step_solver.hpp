/// @file
/// Efforts of a step, chosen by a controller where there is one.
#pragma once

#include <span>
#include <vector>

#include "sinew/step/direct_solver.hpp"
#include "sinew/step/law_status.hpp"
#include "sinew/step/response.hpp"

namespace sinew::step {

class Controller;

/// Without a controller, the direct solver. With one, in rounds: the controller chooses its efforts
/// for the robot as it answers while every other block keeps its state (Response); the direct
/// solver then finds what the others really do at these efforts; and where a contact opened, a
/// cable began to slide or a drive's curve bent, the controller chooses again.
///
/// Rounds that go back and forth have an optimum between them where a block is about to change its
/// state: a point that just touches. It is looked for between the last two choices, by golden
/// section on what the robot really does there, with the least effort among equals (a motor that
/// pushes a joint against its stop); and the last step's efforts stay where nothing better is
/// found, so that a robot held back by a wall comes to rest. Where an actuator holds the very
/// motion of a controlled one (a commanded cable on the same line), the controller may take over
/// its load: that is tried as well, and kept where it comes nearer to the goal. (A nearer place
/// along the kink, where the point goes on just touching, is not looked for.) Every block but the
/// controller's objective is obeyed exactly, whatever the rounds did.
class StepSolver {
 public:
  explicit StepSolver(const qp::ConeSettings& settings = {}) : direct_(settings) {}

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
  struct Trial {
    double miss = kInfinity;  // m
    double strain = 0.0;      // J, sum of W_kk lambda_k^2
  };
  /// Efforts of the controlled actuators, all others by the direct solver.
  Trial try_efforts(const StepProblem& problem, const Controller& controller,
                    std::span<const double> own, std::span<double> effort);
  static bool is_better(const Controller& controller, const Trial& one, const Trial& other);
  void search(const StepProblem& problem, const Controller& controller, std::span<double> effort);
  /// Rounds until states and efforts agree.
  LawStatus settle(const StepProblem& problem, Controller& controller, std::span<double> effort);
  /// Tries to take the place of what holds the motion of a controlled actuator.
  LawStatus take_over(const StepProblem& problem, Controller& controller, std::span<double> effort);
  void measure_motion(const StepProblem& problem, std::span<const double> effort);

  DirectSolver direct_;
  Response response_;
  std::vector<double> chosen_, chosen_before_, trial_;  // (controlled,) N, of the last two rounds
  std::vector<double> held_;                            // (controlled,) N, without taking over
  VectorX motion_;                                      // (rows,) m
};

}  // namespace sinew::step
