/// @file
/// "Solve the law": the one stage in which direct simulation and control differ.
#pragma once

#include <span>
#include <vector>

#include "sinew/constraint/constraint.hpp"
#include "sinew/core/types.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

class Model;

/// What a law may look at. delta = delta_free + W lambda is the motion at the end of the step, as
/// the linearisation sees it. World::law_problem() makes the first, a law that wraps another the
/// next with reduced(): every member is then there.
struct LawProblem {
  const Model& model;
  const constraint::Placement& placement;    ///< at the linearisation
  std::span<const ActuatorRange> actuators;  ///< the model's actuators, then its guides
  const MatrixX& compliance;                 ///< W (rows, rows), m/N
  const VectorX& delta_free;                 ///< (rows,) m or m^3
  const VectorX& delta;                      ///< (rows,) m or m^3, at the linearisation
  const std::vector<char>& present;          ///< (rows,) 0: a contact's row that is left out
  double time;                               ///< s, end of the step
  double time_step;                          ///< s

  /// The same problem with other ranges.
  LawProblem with_ranges(std::span<const ActuatorRange> ranges) const {
    return reduced(ranges, compliance, delta_free);
  }
  /// What is left for an inner law: other ranges, and motions that follow from fewer efforts.
  LawProblem reduced(std::span<const ActuatorRange> ranges, const MatrixX& inner_compliance,
                     const VectorX& inner_delta_free) const {
    return {model, placement, ranges, inner_compliance, inner_delta_free,
            delta, present,   time,   time_step};
  }
};

/// How solving went.
enum class LawStatus {
  solved,
  limits_conflict,  ///< limits contradict each other in this step; the least violation was taken
  failed,           ///< no efforts could be found
};

class Law {
 public:
  virtual ~Law() = default;
  /// Chooses lambda.
  /// @param problem of this step. @param effort (rows,) N: holds the last step's on entry, lambda
  /// on
  ///   return. Rows without an actuator stay 0.
  virtual LawStatus solve(const LawProblem& problem, std::span<double> effort) = 0;
  /// How far `effort` and the motion `problem.delta` are from obeying the law together, m.
  virtual double violation(const LawProblem& problem, std::span<const double> effort) const = 0;
  /// Called before each step: what helped to solve the last one is forgotten, so that a step
  /// follows from state and inputs alone.
  virtual void begin_step() = 0;

  /// What it remembers from one step to the next, as numbers: part of the simulation's state.
  virtual std::size_t memory_size() const { return 0; }
  /// @param memory (memory_size(),).
  virtual void save_memory(std::span<double>) const {}
  virtual void load_memory(std::span<const double>) {}
  /// Remembers nothing, as at the start.
  virtual void forget() {}
};

}  // namespace sinew::sim
