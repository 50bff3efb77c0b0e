/// @file
/// A task as a sparse nonlinear program by direct collocation, with exact first and second
/// derivatives.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "sinew/pcc/arm_equations.hpp"
#include "sinew/plan/drive_transcription.hpp"
#include "sinew/plan/nonlinear_program.hpp"
#include "sinew/plan/point_derivatives.hpp"
#include "sinew/plan/task.hpp"

namespace sinew::plan {

/// Motion and torque at the knots, one a row.
struct Knots {
  VectorX times;                         ///< (knots,) s, from 0
  MatrixX position, rate, acceleration;  ///< (knots, coordinates)
  MatrixX torque;                        ///< (knots, inputs) N m
  std::optional<DriveRun> drive;         ///< of a task with a drive: what makes the torque
};

/// Variables, with b = 2 (q, v) or 3 (q, v, a) blocks a knot:
///
///     knot 0: q v (a) torque | knot 1: q v (a) torque | ... | t_f where the duration is free
///
/// With a drive its volumes and commands stand behind the knots instead of torques in them, and the
/// torque of a stage is the actuator's at the volume of the stage's time.
///
/// Constraints, interval by interval: defects (n), equations of motion of each stage (n each),
/// torque rates (inputs, where limited), clearances of its second knot (points by obstacles); then
/// the tip's distance from the goal and its speed, both as
/// sqrt(|e|^2 + tolerance^2) <= sqrt(2) tolerance: as good as linear far away, smooth at the goal;
/// then the drive's rows.
class Collocation final : public NonlinearProgram {
 public:
  /// @param arm what moves. @param task completed().
  Collocation(std::shared_ptr<const pcc::Arm> arm, Task task);

  const Task& task() const { return task_; }
  int variables() const { return variables_; }
  int constraints() const { return static_cast<int>(constraint_bounds_.lower.size()); }
  VectorX pack(const Knots& knots) const;
  Knots unpack(const VectorX& x) const;
  double duration(const VectorX& x) const;

  double objective(const VectorX& x) override;
  void gradient(const VectorX& x, VectorX& result) override;
  void constraints(const VectorX& x, VectorX& result) override;
  void jacobian(const VectorX& x, double* values) override;
  void hessian(const VectorX& x, double factor, const VectorX& multipliers,
               double* values) override;

 private:
  /// What is done with an entry: its place is noted, or its value.
  template <typename Emit>
  void each_jacobian_entry(const VectorX& x, const Emit& emit);
  template <typename Emit>
  void each_hessian_entry(const VectorX& x, double factor, const VectorX& multipliers,
                          const Emit& emit);
  template <typename Emit>
  void effort_hessian(const VectorX& x, double factor, const Emit& emit);
  template <typename Emit>
  void interval_hessian(const VectorX& x, int k, const VectorX& multipliers, const Emit& emit);
  template <typename Emit>
  void terminal_hessian(const VectorX& x, double factor, const VectorX& multipliers,
                        const Emit& emit);

  void note_patterns();
  void set_bounds();
  /// N m, by which torques are scaled.
  double typical_torque();
  void set_scales(double torque);
  /// Of the first interval, of the others.
  std::array<Transcription, 2> rules(const VectorX& x) const;
  int knot(int k) const { return k * knot_size_; }
  int torque_at(int k) const { return knot(k) + rules_.blocks * n_; }
  int time_at() const { return knot(grid_.intervals + 1); }
  /// First constraint of an interval, of its stage s, of its torque rates, of its clearances.
  int row(int k) const { return k * rows_; }
  int stage_row(int k, int stage) const { return row(k) + n_ * (1 + stage); }
  int rate_row(int k) const { return stage_row(k, static_cast<int>(rules_.stages.size())); }
  int clearance_row(int k) const { return rate_row(k) + (rate_limited_ ? inputs_ : 0); }
  int goal_row() const { return row(grid_.intervals); }
  int speed_row() const { return goal_row() + 1; }
  /// (n, 2 blocks) of what two knots hold; of one.
  MatrixX pair(const VectorX& x, int k) const;
  VectorX state(const VectorX& x, int k, int block) const;
  int drive_row() const { return speed_row() + (speed_limited_ ? 1 : 0); }
  /// What an input's torque follows from at a share of interval k: the knots' torques or, with a
  /// drive, volumes.
  LinearForm input(int k, double share, int u) const;
  /// Torque of such a value and its derivatives by it.
  struct Response {
    double torque, slope, curvature;
  };
  Response response(const VectorX& x, const LinearForm& form, int u) const;
  VectorX torque(const VectorX& x, int k, double share) const;
  /// At knot k.
  VectorX torque(const VectorX& x, int k) const;
  /// of(k, share of the interval, weight) for the points of the effort's quadrature.
  template <typename Do>
  void each_effort_point(const VectorX& x, const Do& of) const;
  template <typename Emit>
  void torque_hessian(const VectorX& x, int k, const Transcription& rules,
                      const VectorX& multipliers, const Emit& emit);
  const VectorDerivatives& tip_position(const VectorX& x);
  const VectorDerivatives& tip_velocity(const VectorX& x);

  std::shared_ptr<const pcc::Arm> arm_;
  Task task_;
  Grid grid_;
  Transcription rules_;
  pcc::ArmEquations equations_;
  PointDerivatives points_;
  std::vector<pcc::ArmPoint> backbone_;
  pcc::ArmPoint tip_;
  int n_, inputs_, knot_size_, variables_, rows_;
  std::unique_ptr<const DriveTranscription> drive_;
  bool rate_limited_ = false, speed_limited_ = true;
};

template <typename Do>
void Collocation::each_effort_point(const VectorX& x, const Do& of) const {
  const std::array<Transcription, 2> both = rules(x);
  for (int k = 0; k < grid_.intervals; ++k) {
    const Transcription& rules = both[k > 0 ? 1 : 0];
    if (rules.begin_share != 0.0) of(k, 0.0, rules.begin_share);
    for (const Stage& stage : rules.stages) of(k, stage.torque[1], stage.share);
  }
}

}  // namespace sinew::plan
