/// @file
/// A task as a sparse nonlinear program by direct collocation, with exact first and second
/// derivatives.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sinew/pcc/arm_equations.hpp"
#include "sinew/plan/drive_transcription.hpp"
#include "sinew/plan/nonlinear_program.hpp"
#include "sinew/plan/point_derivatives.hpp"
#include "sinew/plan/smooth_length.hpp"
#include "sinew/plan/task.hpp"

namespace sinew::plan {

/// Motion and torque at the knots, one a row.
struct Knots {
  VectorX times;                         ///< (knots,) s, from 0
  MatrixX position, rate, acceleration;  ///< (knots, coordinates)
  MatrixX torque;                        ///< (knots, inputs) N m
  std::optional<DriveRun> drive;         ///< of a task with a drive: what makes the torque
};

/// What the program aims at so that the motion of its torques, which differs from the program's own
/// by the transcription's error, does what is asked for. The errors are taken as they were for the
/// plan before (modifier adaptation: Marchetti, Chachuat & Bonvin, Ind. Eng. Chem. Res. 48, 2009).
struct Aim {
  Vector3 position = Vector3::Zero();  ///< m, the tip at the end of the motion less the program's
  Vector3 velocity = Vector3::Zero();  ///< m/s, likewise
  VectorX clearance;                   ///< (obstacles,) m, >= 0, added to what is asked for
  double reserve = 0.02;  ///< fraction of the tolerances that the program leaves, 0 to 1
};

/// Variables, with b = 2 (q, v) or 3 (q, v, a) blocks a knot:
///
///     knot 0: q v (a) torque | knot 1: q v (a) torque | ... | t_f where the duration is free
///
/// With a drive its volumes and commands stand behind the knots instead of torques in them, and the
/// torque of a stage is the actuator's at the volume of the stage's time.
///
/// Constraints, interval by interval: defects (n, where the method has them), equations of motion
/// of each stage (n each), torque rates (inputs, where limited), clearances of its second knot
/// (points by obstacles); then the tip's distance from the goal and its speed, both as sqrt(|e|^2 +
/// d^2) <= sqrt(2) d with d the tolerance less Aim's reserve: as good as linear far away, smooth at
/// the goal; then the drive's rows.
class Collocation final : public NonlinearProgram {
 public:
  /// @param arm what moves. @param task completed().
  Collocation(std::shared_ptr<const pcc::Arm> arm, PlanTask task);

  const PlanTask& task() const { return task_; }
  const Aim& aim() const { return aim_; }
  void set_aim(const Aim& aim);
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
  /// Of the intervals.
  const std::vector<Transcription>& rules(const VectorX& x) const;
  int knot(int k) const { return k * knot_size_; }
  int torque_at(int k) const { return knot(k) + blocks_ * n_; }
  int time_at() const { return knot(grid_.intervals + 1); }
  /// First constraint of an interval, of its stage s, of its torque rates, of its clearances.
  int row(int k) const { return k * rows_; }
  int stage_row(int k, int stage) const { return row(k) + n_ * (defects_ + stage); }
  int rate_row(int k) const { return stage_row(k, stages_); }
  int clearance_row(int k) const { return rate_row(k) + (rate_limited_ ? inputs_ : 0); }
  int goal_row() const { return row(grid_.intervals); }
  int speed_row() const { return goal_row() + 1; }
  /// (n, 2 blocks) of what two knots hold; of one.
  MatrixX pair(const VectorX& x, int k) const;
  VectorX state(const VectorX& x, int k, int block) const;
  int drive_row() const { return speed_row() + (speed_limited_ ? 1 : 0); }
  /// What an input's torque follows from at a fraction of interval k: the knots' torques or, with a
  /// drive, volumes.
  LinearForm input(int k, double fraction, int u) const;
  /// Torque of such a value and its derivatives by it.
  struct Response {
    double torque, slope, curvature;
  };
  Response response(const VectorX& x, const LinearForm& form, int u) const;
  VectorX torque(const VectorX& x, int k, double fraction) const;
  /// At knot k.
  VectorX torque(const VectorX& x, int k) const;
  /// of(k, fraction of the interval, weight) for the points of the effort's quadrature; weights add
  /// up to 1.
  template <typename Do>
  void each_effort_point(const VectorX& x, const Do& of) const;
  template <typename Emit>
  void torque_hessian(const VectorX& x, int k, const Transcription& rules,
                      const VectorX& multipliers, const Emit& emit);
  /// Of the motion's tip from the goal, of its velocity: what the program takes them for.
  SmoothLength distance(const Vector3& tip) const;
  SmoothLength speed(const Vector3& velocity) const;
  const VectorDerivatives& tip_position(const VectorX& x);
  const VectorDerivatives& tip_velocity(const VectorX& x);

  std::shared_ptr<const pcc::Arm> arm_;
  PlanTask task_;
  Grid grid_;
  Aim aim_;
  VectorX begins_;  // (intervals + 1,) fractions of the duration at which intervals begin
  mutable std::vector<Transcription> rules_;
  mutable double rules_duration_ = 0.0;  // s, that they are of
  int blocks_, stages_, defects_;
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
  const std::vector<Transcription>& all = rules(x);
  for (int k = 0; k < grid_.intervals; ++k) {
    for (const CollocationStage& stage : all[static_cast<std::size_t>(k)].stages) {
      of(k, stage.time, stage.fraction * grid_.fractions[k]);
    }
  }
}

}  // namespace sinew::plan
