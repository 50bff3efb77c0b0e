/// @file
/// The second half of a step of the midpoint rule.
#pragma once

#include <vector>

namespace sinew::sim {

struct Run;
class Substep;

/// Repeats the motion of the first half; bodies and surfaces with prescribed motion are placed at
/// the end of the step. Forces of joints and closed points keep their directions at the middle of
/// the step, but their rows are held at its end: the first half is solved again with targets offset
/// by half of the error at the end, until this error vanishes. For quadratic constraints such
/// forces do no work, and motion and energy do not drift (Gonzalez, Mechanical systems subject to
/// holonomic constraints, Physica D 132 (1999) 165).
class Midpoint {
 public:
  /// @param run must outlive it.
  explicit Midpoint(Run& run);
  /// Completes the step. @param substep that has solved the first half. @param half s, its length.
  void carry_on(Substep& substep, double half);

 private:
  void place(double time);
  double correct();
  void release();

  Run& run_;
  std::vector<double> widened_;  // (rows,) m, offsets of the gaps of closed points
};

}  // namespace sinew::sim
