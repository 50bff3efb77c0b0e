/// @file
/// Whether iterations with the factor of an earlier one pay.
#pragma once

#include <vector>

namespace sinew::run {

/// A motion with a kept factor leaves a part q of the residual, where a new factor leaves about its
/// square. A kept factor pays while few such motions reach the tolerance: four or five cost as
/// much as a factor. How small q is depends on the robot and on how it moves, and changes little
/// from step to step, so it is remembered, and measured again after some steps without one.
class KeptFactors {
 public:
  KeptFactors() = default;
  /// @param numbers from save().
  explicit KeptFactors(const std::vector<double>& numbers) {
    if (numbers.size() == 3) left_ = numbers[0], next_ = numbers[1], age_ = numbers[2];
  }
  /// Writes what is remembered as part of the state; empty if that is nothing.
  void save(std::vector<double>& numbers) const;

  /// Whether to keep a factor. @param residual,tolerance relative.
  bool pays(double residual, double tolerance) const;
  /// Whether to expect so after the first motion of a step. @param tolerance relative.
  bool will_pay(double tolerance) const { return pays(next_, tolerance); }
  /// Takes the outcome of a search. @param left the part of the residual that its motions with a
  /// kept factor left, the geometric mean; 1 if one was refused; 0: there was none. @param next
  /// relative residual after its first motion.
  void take(double left, double next);

 private:
  double left_ = 0.0;  // 0: not known
  double next_ = 0.0;
  double age_ = 0.0;  // searches since left_ was measured
};

}  // namespace sinew::run
