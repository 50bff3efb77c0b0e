/// @file
/// What chooses the efforts of some actuators in place of their commands.
#pragma once

#include <span>

#include "sinew/core/types.hpp"
#include "sinew/step/law_status.hpp"
#include "sinew/step/with_memory.hpp"

namespace sinew::step {

class Response;
struct Certificate;
struct StepProblem;

/// Whether the guards of a response hold a choice.
enum class Guards {
  none,
  kept,   ///< each has a slack >= 0
  tight,  ///< and those that are tight have none
};

class Controller : public WithMemory {
 public:
  /// How well efforts serve what the controller wants. First the limits of its actuators count,
  /// then its objective.
  struct Merit {
    double excess = 0.0;  ///< the farthest beyond a limit, of its size; 0 within all
    double value = 0.0;   ///< the objective
  };

  /// Called when the law of a step is about to be solved: what is asked is the same in all choices
  /// until the next call. @param problem of the step. @param response of the robot to start from.
  virtual void begin_choices(const StepProblem& problem, const Response& response) = 0;
  /// @param problem of the step. @param response of the robot to the efforts to choose.
  /// @param guards whether the response's hold the choice.
  /// @param effort (controlled,) N, in the order of response.controlled(): problem.effort_before's
  ///   on entry, the chosen ones on return. Failed: there are none within all guards and limits.
  virtual LawStatus choose(const StepProblem& problem, const Response& response, Guards guards,
                           std::span<double> effort) = 0;
  /// Of the last choose(): the objective that it foresees.
  virtual double foreseen() const = 0;
  /// (guards,) >= 0, or of either sign where tight, of the last choose() with guards: how much the
  /// objective would fall for each unit that a guard gave way.
  virtual std::span<const double> guard_multipliers() const = 0;
  /// @param problem of the step. @param motion (rows,) delta at the end of the step.
  /// @param own (controlled,) N. @param effort (rows,) N, those among them.
  virtual Merit merit(const StepProblem& problem, const VectorX& motion,
                      std::span<const double> own, std::span<const double> effort) const = 0;
  /// A lesser gain of Merit::value is not worth a change of efforts.
  virtual double negligible_gain() const { return 0.0; }
  /// Whether it wants to know more of its choices, see take_certificate().
  virtual bool certifies() const { return false; }
  /// Of what accept() was told.
  virtual void take_certificate(const Certificate&) {}
  /// What came of choose(). @param motion (rows,) delta, as everything on the robot obeys its law.
  /// @param problem,response as for choose(). @param own,effort as for merit(); they may differ
  /// from those chosen.
  virtual void accept(const StepProblem& problem, const Response& response, const VectorX& motion,
                      std::span<const double> own, std::span<const double> effort) = 0;
  /// Called before each step: what helped to solve the last one is forgotten, so that a step
  /// follows from state and inputs alone.
  virtual void begin_step() = 0;
};

}  // namespace sinew::step
