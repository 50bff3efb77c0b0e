/// @file
/// Direct collocation: transcribes a task to a sparse nonlinear program with exact first and second
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

/// Motion and torque at the knots; rows are knots.
struct Knots {
  VectorX times;                         ///< (knots,) s, from 0
  MatrixX position, rate, acceleration;  ///< (knots, coordinates)
  MatrixX torque;                        ///< (knots, inputs) N m
  std::optional<DriveRun> drive;  ///< for a task with a drive: its commands, which make the torque
};

/// Corrections of the goal. The simulated motion of the planned torques differs from the motion in
/// the program by the transcription error. The program aims at the goal minus this error, which is
/// taken from the previous plan (modifier adaptation: Marchetti, Chachuat & Bonvin, Ind. Eng. Chem.
/// Res. 48, 2009).
struct Aim {
  Vector3 position = Vector3::Zero();  ///< m, final tip position of the motion minus the program's
  Vector3 velocity = Vector3::Zero();  ///< m/s, final tip velocity, likewise
  VectorX clearance;                   ///< (obstacles,) m, >= 0, added to the required clearance
  double reserve = 0.02;  ///< fraction of the tolerances that the program leaves unused, 0 to 1
};

/// The nonlinear program of a task. Its variables, with b = 2 (q, v) or 3 (q, v, a) blocks per
/// knot, are
///
///     knot 0: q v (a) torque | knot 1: q v (a) torque | ... | t_f if the duration is free
///
/// With a drive, knots have no torques, and the volumes and commands of the drive follow the knots.
/// The torque of a stage is then that of the actuator at the volume of the stage's time.
///
/// The constraints are, interval by interval: defects (n, if the method has them), equations of
/// motion of each stage (n each), torque rates (inputs, if limited), clearances at the second knot
/// (points by obstacles). Then follow the tip's distance from the goal and its speed, both as
/// sqrt(|e|^2 + d^2) <= sqrt(2) d, where d is the tolerance minus Aim's reserve: this is almost
/// linear far from the goal and smooth at the goal. The rows of the drive come last.
class Collocation final : public NonlinearProgram {
 public:
  /// @param arm of the task. @param task completed().
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
  /// Calls emit() for each entry, which notes its position or its value.
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
  /// Scale of torques, N m.
  double typical_torque();
  void set_scales(double torque);
  /// Transcriptions of the intervals.
  const std::vector<Transcription>& rules(const VectorX& x) const;
  int knot(int k) const { return k * knot_size_; }
  int torque_at(int k) const { return knot(k) + blocks_ * n_; }
  int time_at() const { return knot(grid_.intervals + 1); }
  /// First constraint of an interval, of one of its stages, of its torque rates, of its clearances.
  int row(int k) const { return k * rows_; }
  int stage_row(int k, int stage) const { return row(k) + n_ * (defects_ + stage); }
  int rate_row(int k) const { return stage_row(k, stages_); }
  int clearance_row(int k) const { return rate_row(k) + (rate_limited_ ? inputs_ : 0); }
  int goal_row() const { return row(grid_.intervals); }
  int speed_row() const { return goal_row() + 1; }
  /// Variables (n, 2 blocks) of the two knots of interval k.
  MatrixX pair(const VectorX& x, int k) const;
  VectorX state(const VectorX& x, int k, int block) const;
  int drive_row() const { return speed_row() + (speed_limited_ ? 1 : 0); }
  /// The quantity that determines the torque of input u at a fraction of interval k: the torque at
  /// the knots or, with a drive, the volume.
  LinearForm input(int k, double fraction, int u) const;
  /// Torque at such a quantity, and its derivatives with respect to it.
  struct Response {
    double torque, slope, curvature;
  };
  Response response(const VectorX& x, const LinearForm& form, int u) const;
  VectorX torque(const VectorX& x, int k, double fraction) const;
  /// Torque at knot k.
  VectorX torque(const VectorX& x, int k) const;
  /// Calls of(k, fraction of the interval, weight) for each quadrature point of the effort; weights
  /// add up to 1.
  template <typename Do>
  void each_effort_point(const VectorX& x, const Do& of) const;
  template <typename Emit>
  void torque_hessian(const VectorX& x, int k, const Transcription& rules,
                      const VectorX& multipliers, const Emit& emit);
  /// Distance of the tip from the goal, and speed of the tip, corrected by the aim.
  SmoothLength distance(const Vector3& tip) const;
  SmoothLength speed(const Vector3& velocity) const;
  const VectorDerivatives& tip_position(const VectorX& x);
  const VectorDerivatives& tip_velocity(const VectorX& x);

  std::shared_ptr<const pcc::Arm> arm_;
  PlanTask task_;
  Grid grid_;
  Aim aim_;
  VectorX begins_;  // (intervals + 1,) start of each interval, as a fraction of the duration
  mutable std::vector<Transcription> rules_;
  mutable double rules_duration_ = 0.0;  // s, duration for which rules_ hold
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
