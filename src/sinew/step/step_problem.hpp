/// @file
/// The problem of one step as a value: how the rows' motions follow from their efforts, and the law
/// that each row obeys. Copy it to keep it: nothing in it refers to a simulation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/linalg/scratch.hpp"
#include "sinew/step/drive.hpp"
#include "sinew/step/law_status.hpp"

namespace sinew::step {

/// An actuator obeys its command within its limits, exactly. Effort lambda and motion delta lie on
/// a monotone graph:
/// - motion p commanded: delta = p while effort_min < lambda < effort_max; lambda = effort_min with
///   delta >= p (a slack cable); lambda = effort_max with delta <= p (a stalled drive);
/// - effort T commanded: lambda = T while motion_min < delta < motion_max; at motion_max it holds
///   back, lambda <= T; at motion_min it is held, lambda >= T;
/// - with a drive: the drive's curve, and no limits;
/// - owned: a controller chooses the effort, within all limits.
struct ActuatorBlock {
  int row = -1;
  double effort_min = 0.0, effort_max = 0.0;  ///< N, those on rates folded in
  double motion_min = 0.0, motion_max = 0.0;  ///< m
  CommandKind kind = CommandKind::effort;
  double value = 0.0;            ///< the command, clamped into the limits
  bool owned = false;            ///< value and kind do not count
  const Drive* drive = nullptr;  ///< part of the model; shapes the effort in this step
  Drive::Step drive_step{};      ///< what it is asked
  double motion_scale = 1.0;     ///< m per motion: 1, or 1/m^2 of a chamber, one over its area

  /// Becomes a constant effort, whatever the limits. @param effort N or Pa.
  void hold_effort(double effort);
  /// Becomes a commanded effort within the limits that it has. @param effort N or Pa.
  void command_effort(double effort);
  /// Whether a motion is commanded and no limit of effort stands against it.
  bool holds_motion() const;
};

/// Coulomb friction of a cable at a point that it slides through. The row's effort is what the
/// tension loses there: with the tensions before (towards the pull point) and behind it,
///   -grip tension_behind <= lambda <= grip tension_before,
/// the cable sticking in between, delta = held, and sliding at either limit (Euler 1762).
struct CapstanBlock {
  int row = -1;
  int cable = -1;  ///< in StepProblem::actuators; blocks of a cable follow from its pull point on
  double grip = 0.0;  ///< 1 - e^(-mu angle)
  double held = 0.0;  ///< m, delta when the step began
};

/// Tensions of a cable on either side of a point that it slides through, and the limits of the
/// row's effort that follow.
struct GuideTension {
  double before = 0.0, behind = 0.0;  ///< N, towards the pull point and away from it
  bool first = false;                 ///< of its cable, at the pull point

  double lower(const CapstanBlock& block) const { return -block.grip * std::max(behind, 0.0); }
  double upper(const CapstanBlock& block) const { return block.grip * std::max(before, 0.0); }
  double largest() const { return std::max(std::abs(before), std::abs(behind)); }  ///< N
};

/// A point and a surface: rows `row` (normal), `row` + 1 and `row` + 2 (tangential) obey
/// Signorini's and Coulomb's laws. Signorini's is that of the gap at the end of the step, Coulomb's
/// that of the motion along the surface in the step: with velocities d/h (backward Euler) the
/// scheme of Moreau, Jean (1999), Stewart & Trinkle (1996) without restitution, and in a
/// quasi-static step that of incremental friction.
struct ContactBlock {
  int row = -1;
  double friction = 0.0;                ///< Coulomb's coefficient, >= 0
  int contact = -1;                     ///< which contact of the robot the point is of
  Matrix3 frame = Matrix3::Identity();  ///< normal and tangents, columns, in the world's axes
};

/// A row that holds its motion whatever effort that takes: part of a joint or a tie.
struct BilateralBlock {
  int row = -1;
  double motion = 0.0;        ///< m, that delta is held at
  double motion_scale = 1.0;  ///< m per motion
};

/// Stiffness of the robot's tangent that has no place in A, as a spring about where its row is,
///   lambda = -stiffness (delta - delta_now):
/// what couples two bodies (stiffness > 0 of a taut cable between them), and what A has so that it
/// can be factorised and the robot has not (< 0, an anchor: a body that only joints hold has no
/// stiffness against rigid motions of its own). The motion is exactly that of the whole tangent;
/// the force is part of no equilibrium.
struct StiffnessBlock {
  int row = -1;
  double stiffness = 0.0;  ///< N/m; 0: none now, and the effort is 0
};

/// delta = delta_free + compliance lambda at the end of the step, as the linearisation sees it, and
/// one block for every row that may have an effort. Rows without a block, those of effectors, have
/// none.
struct StepProblem {
  MatrixX compliance;                    ///< W (rows, rows), m/N
  VectorX delta_free;                    ///< (rows,) m, or m^3, or rad
  VectorX delta;                         ///< (rows,) at the linearisation
  linalg::AlignedNumbers effort_before;  ///< (rows,) N, of the last step or Newton iteration
  std::vector<ActuatorBlock> actuators;  ///< in the model's order, then of joints (JointRows)
  std::vector<CapstanBlock> capstans;
  std::vector<ContactBlock> contacts;
  std::vector<BilateralBlock> bilaterals;
  std::vector<StiffnessBlock> stiffness;
  double size = 1.0;       ///< m, of the robot: what motions are small beside
  double time = 0.0;       ///< s, end of the step
  double time_step = 0.0;  ///< s; infinite in statics
};

/// Calls visit(block, tension) for all capstans, cable after cable from its pull point on.
/// @param problem of the step. @param effort (rows,) N.
/// @param visit takes a CapstanBlock and its GuideTension.
template <class Visit>
void for_each_guide(const StepProblem& problem, std::span<const double> effort, Visit&& visit) {
  int cable = -1;
  GuideTension tension;
  for (const CapstanBlock& block : problem.capstans) {
    tension.first = block.cable != cable;
    cable = block.cable;
    const int row = problem.actuators[static_cast<std::size_t>(cable)].row;
    tension.before = tension.first ? effort[static_cast<std::size_t>(row)] : tension.behind;
    tension.behind = tension.before - effort[static_cast<std::size_t>(block.row)];
    visit(block, std::as_const(tension));
  }
}

/// How far `effort` and the motion problem.delta are from obeying all blocks together, m. Of owned
/// actuators the limits of their motions count.
/// @param problem of the step. @param effort (rows,) N. @param law how it was found: limits that
/// contradict each other do not count.
double violation(const StepProblem& problem, std::span<const double> effort, LawStatus law);

/// A row whose motion follows from its effort by delta + c lambda = constant.
struct HeldRow {
  int row = -1;
  /// c, m/N or m^3/Pa: 0 held at a motion, -1/slope on a drive's curve, 1/stiffness of a block of
  /// stiffness
  double compliance = 0.0;
};

/// The rows that joints hold: of all bilateral blocks, then of blocks of stiffness that are not
/// zero.
void append_joints(const StepProblem& problem, std::vector<HeldRow>& held);

/// W + C over held rows, both sides scaled so that efforts of different units compare.
struct HeldCompliance {
  MatrixX matrix;  ///< (held, held) of entries of order 1
  VectorX scale;   ///< (held,)
};
HeldCompliance held_compliance(const StepProblem& problem, std::span<const HeldRow> held);

/// Negative eigenvalues of the robot's tangent on the motions that held rows leave,
/// K = A + H^T C^-1 H, C = 0 as the limit of C -> +0. By the inertia of A
/// bordered by H (Sylvester; Haynsworth, Linear Algebra Appl. 1 (1968) 73)
///   n_-(K) = n_-(A) - n_-(W + C) + n_-(C).
/// @param negative_pivots n_-(A). @param negative n_-(W + C). @param held all of C.
int negative_directions(int negative_pivots, int negative, std::span<const HeldRow> held);

/// Whether the robot is stable together with its drives and held rows, whatever A says.
/// @param problem of the step. @param negative_pivots of A.
bool stabilised(const StepProblem& problem, int negative_pivots);

}  // namespace sinew::step
