/// @file
/// The problem of one step as a value: how the motions of rows follow from their efforts, and the
/// law of each row. It does not refer to a simulation, so a copy stays valid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "sinew/core/types.hpp"
#include "sinew/law/drive.hpp"
#include "sinew/law/law_status.hpp"
#include "sinew/linalg/scratch.hpp"

namespace sinew::law {

/// The law of an actuator, which obeys its command within its limits, exactly. Effort lambda and
/// motion delta lie on a monotone graph:
/// - motion p commanded: delta = p while effort_min < lambda < effort_max; lambda = effort_min with
///   delta >= p (a slack cable); lambda = effort_max with delta <= p (a stalled drive);
/// - effort T commanded: lambda = T while motion_min < delta < motion_max; lambda <= T at
///   motion_max, lambda >= T at motion_min, where the motion is held;
/// - with a drive: the drive's curve, and no limits;
/// - owned: a controller chooses the effort, within all limits.
struct ActuatorBlock {
  int row = -1;
  double effort_min = 0.0, effort_max = 0.0;  ///< N, including limits on rates
  double motion_min = 0.0, motion_max = 0.0;  ///< m
  CommandKind kind = CommandKind::effort;
  double value = 0.0;            ///< the command, clamped into the limits
  bool owned = false;            ///< value and kind are ignored
  const Drive* drive = nullptr;  ///< part of the model; determines the effort in this step
  Drive::Step drive_step{};      ///< arguments of the drive
  double motion_scale = 1.0;     ///< m per motion: 1; for a chamber, 1 over its area, 1/m^2
  /// Whether the solution supposes that the effort stays strictly within its limits and the motion
  /// is therefore held at held(), see brace().
  bool braced = false;

  /// Replaces the law by a constant effort, whatever the limits. @param effort N or Pa.
  void hold_effort(double effort);
  /// Replaces the law by a commanded effort within the present limits. @param effort N or Pa.
  void command_effort(double effort);
  /// Whether a motion is commanded without limits of effort.
  bool holds_motion() const;
  /// The motion that this effort holds by a command or at a stop, if it is not at a limit.
  /// @param effort N or Pa.
  std::optional<double> held(double effort) const;
};

/// Coulomb friction of a cable at a point that it slides through. The effort of the row is the loss
/// of tension there. With the tensions before the point (towards the pull point) and behind it,
///   -grip tension_behind <= lambda <= grip tension_before.
/// The cable sticks in between, delta = held, and slides at either limit (Euler 1762).
struct CapstanBlock {
  int row = -1;
  int cable = -1;     ///< index in StepProblem::actuators; blocks are ordered from the pull point
  double grip = 0.0;  ///< 1 - e^(-mu angle)
  double held = 0.0;  ///< m, delta at the start of the step
};

/// Tensions of a cable on either side of a point that it slides through, and the resulting limits
/// of the row's effort.
struct GuideTension {
  double before = 0.0, behind = 0.0;  ///< N, towards the pull point and away from it
  bool first = false;  ///< whether it is the first of its cable, next to the pull point

  double lower(const CapstanBlock& block) const { return -block.grip * std::max(behind, 0.0); }
  double upper(const CapstanBlock& block) const { return block.grip * std::max(before, 0.0); }
  double largest() const { return std::max(std::abs(before), std::abs(behind)); }  ///< N
};

/// A contact point: rows `row` (normal), `row` + 1 and `row` + 2 (tangential) obey Signorini's and
/// Coulomb's laws. Signorini's law holds for the gap at the end of the step, Coulomb's for the
/// tangential motion in the step. With velocities d/h (backward Euler) this is the scheme of
/// Moreau, Jean (1999), Stewart & Trinkle (1996) without restitution; in a quasi-static step it is
/// incremental friction.
struct ContactBlock {
  int row = -1;
  double friction = 0.0;                ///< Coulomb's coefficient, >= 0
  int contact = -1;                     ///< the contact of the robot that has the point
  Matrix3 frame = Matrix3::Identity();  ///< columns: normal and tangents, in world axes
  /// Whether each side is a body with few coordinates or a surface of the world: with other such
  /// points it may be redundant.
  bool rigid = false;
};

/// A row that holds its motion with whatever effort that takes: part of a joint or a tie.
struct BilateralBlock {
  int row = -1;
  double motion = 0.0;        ///< m, value of delta that is held
  double motion_scale = 1.0;  ///< m per motion
};

/// Stiffness of the robot's tangent that is not in A, as a spring about the present motion of the
/// row,
///   lambda = -stiffness (delta - delta_now).
/// It is either stiffness that couples two bodies (stiffness > 0 for a taut cable between them), or
/// minus an anchor (< 0): stiffness that A has only to be factorisable, since a body held only by
/// joints has no stiffness against its rigid motions. The resulting motion is exactly that of the
/// whole tangent; the force is part of no equilibrium.
struct StiffnessBlock {
  int row = -1;
  double stiffness = 0.0;  ///< N/m; 0: none now, and the effort is 0
};

/// The linearised equations delta = delta_free + compliance lambda at the end of a step, and one
/// block for every row that may have an effort. Rows of effectors have no block and no effort.
struct StepProblem {
  MatrixX compliance;                    ///< W (rows, rows), m/N
  VectorX delta_free;                    ///< (rows,) m, or m^3, or rad
  VectorX delta;                         ///< (rows,) value at the linearisation
  linalg::AlignedNumbers effort_before;  ///< (rows,) N, of the last step or Newton iteration
  std::vector<ActuatorBlock> actuators;  ///< in the model's order, then of joints (JointRows)
  std::vector<CapstanBlock> capstans;
  std::vector<ContactBlock> contacts;
  std::vector<BilateralBlock> bilaterals;
  std::vector<StiffnessBlock> stiffness;
  double size = 1.0;       ///< m, size of the robot
  double time = 0.0;       ///< s, end of the step
  double time_step = 0.0;  ///< s; infinite in statics
};

/// Calls visit(block, tension) for all capstans, cable by cable, from its pull point.
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

/// Largest violation of the laws of all blocks by `effort` and the motion problem.delta, m. For
/// owned actuators, the limits of motions count.
/// @param problem of the step. @param effort (rows,) N.
/// @param law how the efforts were found: contradictory limits do not count.
double violation(const StepProblem& problem, std::span<const double> effort, LawStatus law);

/// A row whose motion follows from its effort by delta + c lambda = constant.
struct HeldRow {
  int row = -1;
  /// c, m/N or m^3/Pa: 0 for a held motion, -1/slope on a drive's curve, 1/stiffness for a block of
  /// stiffness.
  double compliance = 0.0;
};

/// Appends the rows of all bilateral blocks, then those of blocks of nonzero stiffness.
void append_joints(const StepProblem& problem, std::vector<HeldRow>& held);

/// W + C over held rows, scaled on both sides so that efforts of different units compare.
struct HeldCompliance {
  MatrixX matrix;  ///< (held, held), entries of order 1
  VectorX scale;   ///< (held,)
};
HeldCompliance held_compliance(const StepProblem& problem, std::span<const HeldRow> held);

/// Number of negative eigenvalues of the robot's tangent on the motions that held rows leave free,
/// K = A + H^T C^-1 H, with C = 0 as the limit C -> +0. By the inertia of A bordered by H
/// (Sylvester; Haynsworth, Linear Algebra Appl. 1 (1968) 73),
///   n_-(K) = n_-(A) - n_-(W + C) + n_-(C).
/// @param negative_pivots n_-(A). @param negative n_-(W + C). @param held all of C.
int negative_directions(int negative_pivots, int negative, std::span<const HeldRow> held);

/// Whether the robot is stable together with its drives and held rows, even if A is indefinite.
/// @param problem of the step. @param negative_pivots of A.
bool stabilised(const StepProblem& problem, int negative_pivots);

/// Whether it is stable if taut cables and limits that are reached hold their motions, too. If so,
/// marks these actuators as braced: DirectSolver then holds their motions, and fails if the efforts
/// leave their limits. The laws' own problem has no unique solution where only these rows make it
/// convex.
/// @param problem of the step. @param effort (rows,) N, which tells what is taut.
/// @param negative_pivots of A.
bool brace(StepProblem& problem, std::span<const double> effort, int negative_pivots);
/// Removes the marks.
void release_braces(StepProblem& problem);

}  // namespace sinew::law
