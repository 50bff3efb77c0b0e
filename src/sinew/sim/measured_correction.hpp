/// @file
/// The correction of a following step, estimated from an earlier one.
#pragma once

#include <optional>
#include <vector>

namespace sinew::sim {

/// The correction c = |A^-1 r| after a step (see distance_bound()) costs a solution with the
/// factor. While the robot moves steadily, r keeps its direction and c/|r| changes slowly: it is
/// measured again after some steps, or when the residual or the motion has changed by a factor of
/// two.
class MeasuredCorrection {
 public:
  MeasuredCorrection() = default;
  /// @param numbers from save().
  explicit MeasuredCorrection(const std::vector<double>& numbers) {
    if (numbers.size() == 4) {
      correction_ = numbers[0], residual_ = numbers[1], move_ = numbers[2], age_ = numbers[3];
    }
  }
  /// Writes the measurement as part of the state; empty if there is none.
  void save(std::vector<double>& numbers) const {
    numbers.clear();
    numbers.reserve(4);  // later steps allocate nothing
    if (correction_ > 0.0) numbers.assign({correction_, residual_, move_, age_});
  }

  /// m, the correction estimated after a step; none: measure it.
  /// @param residual N. @param move m, largest of the step.
  std::optional<double> estimate(double residual, double move) {
    const auto is_like = [](double now, double then) {
      return now > 0.5 * then && now < 2.0 * then;
    };
    const bool steady = is_like(residual, residual_) && is_like(move, move_);
    if (!(correction_ > 0.0) || !steady || ++age_ > kSteps) return {};
    return correction_ * residual / residual_;
  }
  /// Takes a measured correction. @param correction m. @param residual,move as for estimate().
  void take(double correction, double residual, double move) {
    correction_ = correction, residual_ = residual, move_ = move, age_ = 0.0;
  }

 private:
  static constexpr double kSteps = 15.0;
  double correction_ = 0.0, residual_ = 0.0, move_ = 0.0;
  double age_ = 0.0;  // steps since it was measured
};

}  // namespace sinew::sim
