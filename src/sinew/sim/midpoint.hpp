/// @file
/// The second half of a step of the midpoint rule.
#pragma once

#include <vector>

namespace sinew::sim {

struct Run;
class Substep;

/// Repeats the motion of the first half; what moves by itself goes to where it is at the end.
/// Forces of joints and closed points act in the directions that they have in the middle, but what
/// they hold is held at the end of the step: the first half is solved again, with the motions held
/// there off by half of what the end lacks, until it lacks nothing. Of constraints that are
/// quadratic such forces do no work, and motion and energy do not drift (Gonzalez, Mechanical
/// systems subject to holonomic constraints, Physica D 132 (1999) 165).
class Midpoint {
 public:
  /// @param run outlives it.
  explicit Midpoint(Run& run);
  /// @param substep that has solved the first half. @param half s, its length.
  void carry_on(Substep& substep, double half);

 private:
  void place(double time);
  double correct();
  void release();

  Run& run_;
  std::vector<double> widened_;  // (rows,) m, gaps of closed points
};

}  // namespace sinew::sim
