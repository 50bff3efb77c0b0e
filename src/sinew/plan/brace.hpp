/// @file
/// Bracing: finds where an arm can lean against its surroundings to hold its tip more steadily.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "sinew/constraint/smooth_surface.hpp"
#include "sinew/pcc/arm_dynamics.hpp"
#include "sinew/plan/brace_conditions.hpp"
#include "sinew/plan/task.hpp"

namespace sinew::plan {

/// An object that the arm may lean against.
struct BraceObject {
  constraint::SmoothSurface surface;
  FrictionRange friction = kSiliconeOnSteel;
  TouchStiffness stiffness = kRigid;
};

/// The goal of the tip, the objects, and the limits of a brace.
struct BraceTask {
  Vector3 goal = Vector3::Zero();  ///< m, of the tip
  double tolerance = 5e-3;         ///< m, > 0; the search uses 40 % of it
  ArmLimits limits;                ///< on every torque, and on angles
  std::vector<BraceObject> objects;
  /// Range of the base's rotation about the arm's axis, rad. Both 0: the base is fixed.
  double turn_lower = 0.0, turn_upper = 0.0;
  /// Candidates for the braced point: skin points at these fractions (> 0, <= 1) of every segment.
  std::vector<double> fractions{0.25, 0.5, 0.75, 1.0};
  /// Number of equal steps along a segment, >= 1, at which the skin has points besides `fractions`.
  int along = 8;
  /// Number of points around a section, starting at x. 0: 2 for planar arms, 4 for spatial ones.
  int sides = 0;
  double clearance = 1e-3;  ///< m, >= 0, of the other skin points
  /// The braced point must stick under every sum of sinusoidal tip forces with frequencies up to
  /// hold_frequency (Hz, >= 0) and a sum of amplitudes up to hold_force (N, >= 0), see
  /// tip_response().
  double hold_force = 0.04, hold_frequency = 2.0;
  /// Fraction of the minimum friction that a brace may use, 0 to 1.
  double friction_fraction = 0.9;
  double min_force = 0.05;     ///< N, > 0, minimum of the normal force
  double max_force = 20.0;     ///< N, maximum of the normal force
  double force_weight = 1e-3;  ///< 1/N^2, > 0, see BraceProgram
  TouchStiffness arm = kSoftArm;
  double stiffness_ratio = 10.0;  ///< > 0, least ratio for k_O >> k_R
  /// Starts per candidate, >= 1. If these find no brace, up to three times as many follow.
  int starts = 2;
  std::uint64_t seed = 1;
};

/// Checks a task and fills in sizes. Throws what completed_limits() throws, and Error(out-of-range
/// | contradictory-limits | not-finite) for an invalid value, for a goal farther from the base than
/// the length of the arm, and for a rotating base if gravity is not along its axis or there are
/// loads.
BraceTask completed(const pcc::Arm& arm, BraceTask task);

/// Points of the skin, ordered by segment, fraction and side.
/// @param arm of the task. @param task completed().
std::vector<pcc::ArmPoint> skin_points(const pcc::Arm& arm, const BraceTask& task);
/// The points of the skin that may be braced. @param arm of the task. @param task completed().
std::vector<pcc::ArmPoint> brace_points(const pcc::Arm& arm, const BraceTask& task);

enum class BraceStatus {
  braced,              ///< all three conditions hold
  infeasible,          ///< no brace was found from any start, or there is no object
  no_object_in_reach,  ///< the arm cannot touch any object
};
/// "braced", "infeasible", "no-object-in-reach".
std::string_view status_name(BraceStatus status);

/// An equilibrium of the arm in which one point of its skin sticks to an object. If no brace was
/// found and object >= 0, it is the equilibrium that came closest to satisfying the conditions.
struct Brace {
  BraceStatus status = BraceStatus::infeasible;
  int segments = 0;                                 ///< n: the braced point is on segment n - 1
  int object = -1;                                  ///< index in BraceTask::objects
  pcc::ArmPoint point;                              ///< the braced point
  VectorX position;                                 ///< (coordinates,)
  VectorX torque;                                   ///< (inputs,) N m
  double turn = 0.0;                                ///< rad, of the base
  Vector3 place = Vector3::Zero();                  ///< m, position of the braced point
  Vector3 normal = Vector3::Zero();                 ///< outward normal of the object
  Vector3 force = Vector3::Zero();                  ///< N, on the arm
  double normal_force = 0.0, friction_force = 0.0;  ///< N
  Vector3 tip = Vector3::Zero();                    ///< m
  double tip_error = 0.0;                           ///< m
  double gap = 0.0;                                 ///< m, of the braced point
  double clearance = 0.0;                           ///< m, minimum over the other skin points
  double balance = 0.0;  ///< N m, largest component of K q + G - B tau - J^T f
  /// Largest compliance of the tip while the braced point sticks, m/N: static, and over all
  /// frequencies up to hold_frequency.
  double tip_compliance = 0.0, peak_compliance = 0.0;
  double hold_force = 0.0;  ///< N, tip force up to which it sticks at minimum friction
  int mobility = 0;         ///< number of directions in which the tip can still move
  std::array<BraceCondition, 3> conditions;
  int solved = 0, unstable = 0, tried = 0;  ///< numbers of equilibria, unstable ones, and programs

  bool found() const { return status == BraceStatus::braced; }
};

/// Finds the best brace on segment n - 1. It solves one BraceProgram for every object, candidate
/// point, smooth piece of the surface and start, and solves it again until its friction reserve is
/// the one that its equilibrium needs. Among the stable equilibria for which all conditions hold
/// (that of friction under the task's tip force), it selects the one with the least peak compliance
/// of the tip. Throws what completed() throws, and Error(out-of-range).
/// @param arm to be braced. @param task to which completed() is applied.
/// @param segments n, from 1 to the number of segments.
Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task, int segments);
/// Finds the first brace for n = 1, 2, ... If there is none, returns the result for the last n.
/// Without objects, this is `infeasible`.
Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task);

/// Plans a brace again, with the braced point held where the measured angles put it. The unknowns
/// are the torques, the force and the free angles: those beyond the brace, and before it those that
/// holding the point leaves free. It may use half the minimum force, 95 % of the minimum friction
/// and the full tolerance, since the reserves are meant for the way there. If friction has less
/// reserve than the task asks for, its condition says so.
/// @param arm,task as for find_brace(). @param before result of find_brace().
/// @param measured (coordinates,) rad. Throws Error: out-of-range, wrong-length.
Brace replan_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task,
                   const Brace& before, const VectorX& measured);

/// Largest compliance (m/N) of the tip about an equilibrium without a brace, over all frequencies
/// up to `frequency`; infinite if the equilibrium is not stable. @param arm without a brace.
/// @param position (coordinates,) of the equilibrium. @param frequency Hz, >= 0.
double free_tip_compliance(const std::shared_ptr<const pcc::Arm>& arm, const VectorX& position,
                           double frequency = 0.0);

}  // namespace sinew::plan
