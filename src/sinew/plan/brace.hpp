/// @file
/// Bracing: where an arm leans against its surroundings so that its tip is held steadier.
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

/// What the arm may lean against.
struct BraceObject {
  constraint::SmoothSurface surface;
  FrictionRange friction = kSiliconeOnSteel;
  TouchStiffness stiffness = kRigid;
};

struct BraceTask {
  Vector3 goal = Vector3::Zero();  ///< m, of the tip
  double tolerance = 5e-3;         ///< m, > 0; a brace is found with 40 % of it
  ArmLimits limits;                ///< on torque, all of them, and on angles
  std::vector<BraceObject> objects;
  /// rad: the base turns about the arm's axis by an angle between these. Both 0: it does not.
  double turn_lower = 0.0, turn_upper = 0.0;
  /// Candidates for the braced point: skin points at these fractions, > 0, of every segment.
  std::vector<double> fractions{0.25, 0.5, 0.75, 1.0};
  /// >= 1: number of equal steps along a segment at which the skin has points, besides fractions.
  int along = 8;
  /// Number of points around a section, from x on. 0: 2 for planar arms, 4 for spatial ones.
  int sides = 0;
  double clearance = 1e-3;  ///< m, >= 0, of the points of the skin that are not braced
  /// The braced point must stick under any sum of sinusoidal tip forces with frequencies up to
  /// hold_frequency (Hz, >= 0) and amplitudes that add up to hold_force (N, >= 0): see
  /// tip_response().
  double hold_force = 0.04, hold_frequency = 2.0;
  /// 0 to 1: of the friction's least, that a brace may need for it.
  double friction_fraction = 0.9;
  double min_force = 0.05;     ///< N, > 0, of the normal force
  double max_force = 20.0;     ///< N
  double force_weight = 1e-3;  ///< 1/N^2, > 0, see BraceProgram
  TouchStiffness arm = kSoftArm;
  double stiffness_ratio = 10.0;  ///< > 0, what k_O >> k_R means
  /// >= 1, of each candidate. Without a brace after these, up to three times as many follow.
  int starts = 2;
  std::uint64_t seed = 1;
};

/// With sizes filled in. Throws what completed_limits() throws, and Error(out-of-range |
/// contradictory-limits | not-finite): what makes no sense, a goal that is farther from the base
/// than the arm is long, a base that turns where gravity is not along its axis or loads are.
BraceTask completed(const pcc::Arm& arm, BraceTask task);

/// Points of the skin, by segment, then part of its length, then side. @param arm which.
/// @param task completed().
std::vector<pcc::ArmPoint> skin_points(const pcc::Arm& arm, const BraceTask& task);
/// Those of them that may be braced.
std::vector<pcc::ArmPoint> brace_points(const pcc::Arm& arm, const BraceTask& task);

enum class BraceStatus {
  braced,              ///< found: all three conditions hold
  infeasible,          ///< nothing found from any start, or there is no object
  no_object_in_reach,  ///< none that the arm could touch, whatever its shape
};
/// "braced", "infeasible", "no-object-in-reach".
std::string_view status_name(BraceStatus status);

/// An equilibrium of the arm with one point of its skin on an object, which sticks there. Where
/// none was found: the one that came nearest to meeting the conditions, if object >= 0.
struct Brace {
  BraceStatus status = BraceStatus::infeasible;
  int segments = 0;                                 ///< n: the braced point is on segment n - 1
  int object = -1;                                  ///< of BraceTask::objects
  pcc::ArmPoint point;                              ///< that touches
  VectorX position;                                 ///< (coordinates,)
  VectorX torque;                                   ///< (inputs,) N m
  double turn = 0.0;                                ///< rad, of the base
  Vector3 place = Vector3::Zero();                  ///< m, of the braced point, on the object
  Vector3 normal = Vector3::Zero();                 ///< out of the object
  Vector3 force = Vector3::Zero();                  ///< N, on the arm
  double normal_force = 0.0, friction_force = 0.0;  ///< N
  Vector3 tip = Vector3::Zero();                    ///< m
  double tip_error = 0.0;                           ///< m
  double gap = 0.0;                                 ///< m, of the braced point
  double clearance = 0.0;                           ///< m, the least of the skin's other points
  double balance = 0.0;  ///< N m, largest component of K q + G - B tau - J^T f
  /// m/N, the largest while the braced point sticks: at rest, and of all up to the frequency.
  double tip_compliance = 0.0, peak_compliance = 0.0;
  double hold_force = 0.0;  ///< N, on the tip, up to which it sticks where friction is least
  int mobility = 0;         ///< directions in which the tip still moves then
  std::array<BraceCondition, 3> conditions;
  int solved = 0, unstable = 0, tried = 0;  ///< programs: equilibria found, unstable ones of them

  bool found() const { return status == BraceStatus::braced; }
};

/// Braces on segment n - 1: of every object, candidate point, smooth piece of the surface and start
/// one program (see BraceProgram), solved anew until the reserve of friction that it keeps is its
/// own equilibrium's; of the stable equilibria for which all conditions hold, friction's under the
/// force to be held against, the one with the least peak compliance of the tip.
/// @param arm which. @param task completed() is applied.
/// @param segments n, 1 to the arm's. Throws what completed() throws, and Error(out-of-range).
Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task, int segments);
/// The first found with n = 1, 2, ... Without any: the last, and why. Without objects: infeasible.
Brace find_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task);

/// The rest anew, with the braced point where the measured angles put it: torques, force, and what
/// angles it leaves (those behind the brace, and where more are before it than hold the point, a
/// bend there too). Half the least force will do, 95 % of the friction's least may be needed, and
/// the whole tolerance: reserves are for the way there. Friction may have less in reserve than was
/// asked for; then its condition says so.
/// @param arm,task as of find_brace(). @param before what was found.
/// @param measured (coordinates,) rad.
Brace replan_brace(const std::shared_ptr<const pcc::Arm>& arm, const BraceTask& task,
                   const Brace& before, const VectorX& measured);

/// Largest compliance (m/N) of the tip about a pose at rest without a brace, of all up to a
/// frequency; infinite where the pose is not stable. @param arm which. @param position of it,
/// (coordinates,). @param frequency Hz, >= 0.
double free_tip_compliance(const std::shared_ptr<const pcc::Arm>& arm, const VectorX& position,
                           double frequency = 0.0);

}  // namespace sinew::plan
