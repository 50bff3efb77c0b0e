/// @file
/// The requirements on the result of a step, whatever the scene combines. They are evaluated from
/// states, reactions, contact forces and weights, not from the equation that the step solved.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/core/types.hpp"

namespace sinew::sim {
class Simulation;
}

namespace sinew::combine {

/// Checks the steps of one simulation, which must call begin() before each step and end() after it:
/// - A step that is not flagged has a residual within its tolerance, and says that it is balanced.
/// - Shapes are sane: det F > 0, stretches below 50, chambers with a volume, all numbers finite.
/// - At rest, the forces on every free node sum to no more than the reported residual, and the
///   reactions of a body balance all loads, rows and contacts.
/// - In motion, the momentum of a free body changes by its weight and its contact force (backward
///   Euler and BDF2, whose velocities are those of their formula).
class StepCheck {
 public:
  /// @param simulation must outlive it.
  explicit StepCheck(sim::Simulation& simulation);
  void begin();
  /// What is wrong after a step; empty if nothing is.
  std::string end();

 private:
  std::string check_report() const;
  std::string check_shapes();
  std::string check_rest(int body);
  std::string check_motion(int body);
  std::optional<Vector3> momentum(int body) const;
  Vector3 momentum_change(int body) const;

  sim::Simulation& simulation_;
  // (bodies,) kg m/s, at the start of this step and of the step before; of free bodies only.
  std::vector<std::optional<Vector3>> start_, before_;
};

}  // namespace sinew::combine
