/// @file
/// Levenberg-Marquardt damping: how far a linearisation is trusted.
#pragma once

namespace sinew::control {

/// Adapts the damping of a controller's steps. Its least-squares steps omit second derivatives,
/// which matter as much as the first if the error is large and the robot curved; the steps may then
/// chatter. The weight on changes of effort is multiplied by value(). It grows fourfold after a
/// step whose outcome misses the prediction by more than three quarters of the predicted change,
/// and halves after one within a quarter. It does not move a fixed point of the steps. Where W_ea
/// is zero because the effector is as far as an effort can take it, such as at the largest x over
/// the pull of one cable, only second derivatives count. InverseController explains how the outcome
/// shows there, and EffortPull explains the weight.
/// Source: J. J. More, The Levenberg-Marquardt algorithm, Lecture Notes in Mathematics 630 (1978)
/// 105-116, section 4; J. Nocedal and S. J. Wright, Numerical Optimization (2006), algorithm 4.1.
class StepDamping {
 public:
  /// Adapts the damping to the outcome of a step.
  /// @param before,foreseen,found objectives with the targets of that step: without the change of
  ///   efforts, after it as predicted by the linearisation, and after it as it turned out.
  /// @param negligible objective that counts as zero.
  /// @return false if the objectives differ too little to judge; value() is then unchanged.
  bool review(double before, double foreseen, double found, double negligible);
  /// Increases the damping sixteenfold after a step that failed: its outcome counts as infinitely
  /// worse than predicted.
  void reject();
  /// Halves the damping, down to 1.
  void relax();
  /// >= 1, no unit.
  double value() const { return value_; }
  /// @param value >= 1.
  void set(double value) { value_ = value; }

 private:
  double value_ = 1.0;
};

}  // namespace sinew::control
