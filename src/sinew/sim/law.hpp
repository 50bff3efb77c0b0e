/// @file
/// "Solve the law": the one stage in which direct simulation and control differ.
#pragma once

#include <span>

#include "sinew/constraint/constraint.hpp"
#include "sinew/core/types.hpp"
#include "sinew/sim/actuator.hpp"

namespace sinew::sim {

class Model;

/// What a law may look at. delta = delta_free + W lambda is the motion at the end of the step, as
/// the linearisation sees it.
struct LawProblem {
  const Model& model;
  const constraint::Placement& placement;    ///< at the linearisation
  std::span<const ActuatorRange> actuators;  ///< the model's actuators, then its guides
  const MatrixX& compliance;                 ///< W (rows, rows), m/N
  const VectorX& delta_free;                 ///< (rows,) m or m^3
  const VectorX& delta;                      ///< (rows,) m or m^3, at the linearisation
  double time = 0.0;                         ///< s, end of the step
  double time_step = 0.0;                    ///< s
  std::span<const char> present;             ///< (rows,) 0: a contact's row that is left out
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
  /// Forgets what earlier steps left for a warm start.
  virtual void reset() = 0;
};

}  // namespace sinew::sim
