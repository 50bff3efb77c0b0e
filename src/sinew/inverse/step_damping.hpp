/// @file
/// How far a linearisation is trusted: Levenberg and Marquardt's damping.
#pragma once

namespace sinew::inverse {

/// The least-squares steps of a controller may chatter where the error is large and the robot
/// curved: then second derivatives, which they leave out, matter as much as the first. The weight
/// on changes of effort is multiplied by value(): four times larger after a step whose outcome is
/// farther from what was foreseen than three quarters of the foreseen change, half as large after
/// one within a quarter. A fixed point of the steps does not depend on it. Where the effector is as
/// far as an effort takes it and W_ea is zero, as at the largest x over the pull of one cable, the
/// second derivatives are all that counts; see InverseController for how the outcome shows there,
/// and EffortPull for the weight.
/// Source: J. J. More, The Levenberg-Marquardt algorithm, Lecture Notes in Mathematics 630 (1978)
/// 105-116, section 4; J. Nocedal and S. J. Wright, Numerical Optimization (2006), algorithm 4.1.
class StepDamping {
 public:
  /// @param before,foreseen,found objectives: before a step, after it by the linearisation, and
  ///   after it in truth, all with the targets of that step.
  /// @param negligible objective that is as good as zero. False: there was too little to judge by.
  bool review(double before, double foreseen, double found, double negligible);
  /// Trusts the linearisation twice as far.
  void relax();
  /// >= 1, no unit.
  double value() const { return value_; }
  /// @param value >= 1.
  void set(double value) { value_ = value; }

 private:
  double value_ = 1.0;
};

}  // namespace sinew::inverse
