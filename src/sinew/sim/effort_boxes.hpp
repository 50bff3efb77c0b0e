/// @file
/// What an actuator may do in a step as limits on its effort and the motion that holds in between.
#pragma once

#include <span>
#include <vector>

#include "sinew/sim/law.hpp"

namespace sinew::sim {

/// lambda in [lower, upper]; delta = motion strictly between, >= motion at `lower`, <= motion at
/// `upper`.
struct EffortBox {
  double lower = 0.0, upper = 0.0;
  double motion = 0.0;
};

/// Each range is the monotone graph that DirectLaw describes. A motion range is one box; an effort
/// range with limits on its stroke is one of two, at or below the commanded effort and above it,
/// and branches are switched until the motions agree.
class EffortBoxes {
 public:
  /// @param ranges of the model, see Model::range_count().
  explicit EffortBoxes(int ranges);

  std::size_t size() const { return branch_.size(); }
  /// @param range number. @param what its range is.
  EffortBox box(std::size_t range, const ActuatorRange& what) const;
  /// Whether a range changed its branch. @param range number. @param what,motion of it.
  bool switch_branch(std::size_t range, const ActuatorRange& what, double motion);
  /// The worst miss of any range, m. @param problem,effort as Law::violation().
  double violation(const LawProblem& problem, std::span<const double> effort) const;
  void reset();

 private:
  enum class Branch : char { pull, hold };  // an effort row at or below T, or above it
  std::vector<Branch> branch_;
};

}  // namespace sinew::sim
