/// @file
/// What chooses the efforts of some actuators in place of their commands.
#pragma once

#include <cstddef>
#include <span>

#include "sinew/core/types.hpp"
#include "sinew/step/law_status.hpp"

namespace sinew::step {

class Response;
struct StepProblem;

class Controller {
 public:
  virtual ~Controller() = default;
  /// @param problem of the step. @param response of the robot to the efforts to choose.
  /// @param effort (controlled,) N, in the order of response.controlled(): problem.effort_before's
  ///   on entry, the chosen ones on return.
  virtual LawStatus choose(const StepProblem& problem, const Response& response,
                           std::span<double> effort) = 0;
  /// How far the motions at the end of the step are from what the controller wants, m.
  /// @param problem of the step. @param motion (rows,) delta.
  virtual double miss(const StepProblem& problem, const VectorX& motion) const = 0;
  /// A lesser miss is not worth a change of efforts, m.
  virtual double negligible_miss() const { return 0.0; }
  /// What came of choose(). @param motion (rows,) delta, as everything on the robot obeys its law.
  /// @param problem,response,effort as for choose(); efforts may differ from those chosen.
  virtual void accept(const StepProblem& problem, const Response& response, const VectorX& motion,
                      std::span<const double> effort) = 0;
  /// Called before each step: what helped to solve the last one is forgotten, so that a step
  /// follows from state and inputs alone.
  virtual void begin_step() = 0;

  /// What it remembers from one step to the next, as numbers: part of the simulation's state.
  virtual std::size_t memory_size() const { return 0; }
  /// Into and from (memory_size(),) numbers.
  virtual void save_memory(std::span<double>) const {}
  virtual void load_memory(std::span<const double>) {}
  /// Remembers nothing, as at the start.
  virtual void forget() {}
};

}  // namespace sinew::step
