/// @file
/// The correction of a following step, estimated from an earlier one.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace sinew::run {

/// The correction c = |A^-1 r| after a step (see distance_bound()) costs a solution with the
/// factor. While the robot moves steadily, r keeps its direction and c/|r| changes slowly: it is
/// measured again after some steps, or when the residual or the motion has changed by a factor of
/// two. The number of steps doubles while the measurements agree with what was estimated before
/// them, and is one after a measurement that does not.
class MeasuredCorrection {
 public:
  MeasuredCorrection() = default;
  /// @param numbers from save(), or without the last one.
  explicit MeasuredCorrection(const std::vector<double>& numbers) {
    if (numbers.size() < 4) return;
    correction_ = numbers[0], residual_ = numbers[1], move_ = numbers[2], age_ = numbers[3];
    if (numbers.size() > 4) steps_ = numbers[4];
  }
  /// Writes the measurement as part of the state; empty if there is none.
  void save(std::vector<double>& numbers) const {
    numbers.clear();
    numbers.reserve(5);  // later steps allocate nothing
    if (correction_ > 0.0) numbers.assign({correction_, residual_, move_, age_, steps_});
  }

  /// m, the correction estimated after a step; none: measure it.
  /// @param residual N. @param move m, largest of the step.
  std::optional<double> estimate(double residual, double move) {
    if (!is_steady(residual, move) || ++age_ >= steps_) return {};
    return kGrowth * correction_ * residual / residual_;
  }
  /// Takes a measured correction. @param correction m. @param residual,move as for estimate().
  void take(double correction, double residual, double move) {
    const double expected = is_steady(residual, move) ? correction_ * residual / residual_ : 0.0;
    const bool agrees = correction < kAgrees * expected && expected < kAgrees * correction;
    steps_ = agrees ? std::min(2.0 * steps_, kMostSteps) : 1.0;
    correction_ = correction, residual_ = residual, move_ = move, age_ = 0.0;
  }

 private:
  bool is_steady(double residual, double move) const {
    const auto is_like = [](double now, double then) {
      return now > 0.5 * then && now < 2.0 * then;
    };
    return correction_ > 0.0 && is_like(residual, residual_) && is_like(move, move_);
  }

  static constexpr double kMostSteps = 16.0;
  static constexpr double kAgrees = 1.1;
  // By which c/|r| may grow before the next measurement: its change since the last one, doubled.
  static constexpr double kGrowth = 1.2;
  double correction_ = 0.0, residual_ = 0.0, move_ = 0.0;
  double age_ = 0.0;    // steps since it was measured
  double steps_ = 1.0;  // from one measurement to the next
};

}  // namespace sinew::run
