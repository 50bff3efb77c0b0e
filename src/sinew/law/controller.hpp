/// @file
/// Interface of controllers that choose the efforts of actuators within a step.
#pragma once

#include <span>

#include "sinew/core/types.hpp"
#include "sinew/law/law_status.hpp"
#include "sinew/law/with_memory.hpp"

namespace sinew::law {

class Response;
struct Certificate;
struct StepProblem;

/// Whether the guards of a response constrain a choice.
enum class Guards {
  none,
  kept,   ///< each has a slack >= 0
  tight,  ///< as kept, and tight guards have zero slack
};

/// A controller whose efforts are part of the solution of a step.
class Controller : public WithMemory {
 public:
  /// Merit of efforts for the controller. The violation of the limits of its actuators counts
  /// first, then its objective.
  struct Merit {
    double excess = 0.0;  ///< largest violation, relative to a limit's size; 0 within all
    double value = 0.0;   ///< the objective
  };

  /// Called before the law of a step is solved. The goal then stays the same for all choices until
  /// the next call. @param problem of the step. @param response of the robot to start from.
  virtual void begin_choices(const StepProblem& problem, const Response& response) = 0;
  /// Chooses the efforts. @param problem of the step.
  /// @param response of the robot to the efforts to be chosen.
  /// @param guards whether the guards of the response constrain the choice.
  /// @param effort (controlled,) N, in the order of response.controlled(): on entry those of
  ///   problem.effort_before, on return the chosen ones. @return failed if no efforts meet all
  ///   guards and limits.
  virtual LawStatus choose(const StepProblem& problem, const Response& response, Guards guards,
                           std::span<double> effort) = 0;
  /// Predicted objective of the last choose().
  virtual double foreseen() const = 0;
  /// Multipliers of the guards in the last choose() with guards, (guards,), >= 0, or of either sign
  /// for tight ones: the decrease of the objective per unit by which a guard is relaxed.
  virtual std::span<const double> guard_multipliers() const = 0;
  /// Evaluates efforts. @param problem of the step. @param motion (rows,) delta at the end of the
  /// step.
  /// @param own (controlled,) N. @param effort (rows,) N, including those.
  virtual Merit merit(const StepProblem& problem, const VectorX& motion,
                      std::span<const double> own, std::span<const double> effort) const = 0;
  /// A smaller gain of Merit::value does not justify a change of efforts.
  virtual double negligible_gain() const { return 0.0; }
  /// Whether its choices get a certificate, see take_certificate().
  virtual bool certifies() const { return false; }
  /// Receives the certificate of the efforts given to accept().
  virtual void take_certificate(const Certificate&) {}
  /// Receives the outcome of choose(). @param motion (rows,) delta, with everything on the robot
  /// obeying its law. @param problem,response as for choose().
  /// @param own,effort as for merit(); they may differ from those chosen.
  virtual void accept(const StepProblem& problem, const Response& response, const VectorX& motion,
                      std::span<const double> own, std::span<const double> effort) = 0;
  /// Called before each step. Discards all warm starts of the last step, so that a step is
  /// determined by state and inputs alone. @param failures how often this step has failed with the
  ///   controller's choices: each time, it must choose a smaller change of efforts.
  virtual void begin_step(int failures) = 0;
  /// Called after a step that could not be solved with its choice, and for which its actuators kept
  /// the efforts of the last step. @param failures how often its choices failed without a
  ///   begin_choices() that followed, each of which makes it trust its linearisation less.
  virtual void hold_back(int failures) = 0;
};

}  // namespace sinew::law
